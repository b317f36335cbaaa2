// SPDX-License-Identifier: Apache-2.0
#include "device_report.h"

#include <algorithm>
#include <cmath>

#include "core/devices/path/path.h"
#include "palpate/report/program.h"
#include "palpate/report/text_chart.h"
#include "tools/program/printed.h"
#include "tools/program/svg_plot.h"

namespace palpate::device {
namespace {

using program::Json;
using program::printed;

double depthOf(const Motion& motion, const Point& tip) {
  return motion.tip_radius - dot(tip - motion.surface, motion.normal);
}

double largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

// K_vc as the server states it, N/m; null without a coupling, because JSON has no infinity.
Json couplingOf(const dds::ServerStatus& status) {
  return std::isfinite(status.coupling_stiffness) ? Json(status.coupling_stiffness) : Json(nullptr);
}

std::string settled(const Verdict& verdict) {
  return verdict.settle_s ? printed("settles within %.3f s of the hold", *verdict.settle_s)
                          : "does not settle";
}

// "gave 1.301 mJ", "took 0.420 mJ"
std::string workText(double work) {
  return printed("%s %.3f mJ", work > 0.0 ? "gave" : "took", 1e3 * std::abs(work));
}

std::string energyText(const EnergyVerdict& energy) {
  std::string text = printed("%zu contacts", energy.contacts.size() - energy.stalls);
  const AlongForce& sum = energy.judged;
  if (sum.speed_squared > 0.0)
    text += printed(
        ": the organ %s, as a damping of %.3f N s/m along the force does; device and hand damped %.3f mJ",
        workText(sum.work).c_str(), -sum.work / sum.speed_squared, 1e3 * sum.damped);
  if (const ContactEnergy* worst = energy.worst(); worst != nullptr && !worst->holds())
    text += printed("\nUNSTABLE: in the contact at %.3f s it gave %.3f mJ, %.3f mJ more than was damped",
                    1e-3 * static_cast<double>(worst->first), 1e3 * worst->along.work, 1e3 * worst->excess());
  if (energy.stalls > 0)
    text += printed("\n%zu contacts more had a stall and are not judged: the organ %s", energy.stalls,
                    workText(energy.stalled.work).c_str());
  return text + '\n';
}

const char* verdictText(const Session& s) {
  if (!s.complete()) return "ended early, so not judged";
  if (!s.touched()) return "no contact, so not judged";
  if (!s.judged()) return "stalls left too little of the hold, so not judged";
  return s.stable() ? "stable" : "UNSTABLE";
}

Json delaysJson(const Session& s) {
  if (s.delays == nullptr) return nullptr;
  return {{"file", s.delay_from},           {"poses", s.delays->poses()},
          {"lost", s.delays->lost()},       {"reordered", s.delays->reordered()},
          {"periods", s.delays->size()},    {"left_out", s.delays->stalled()},
          {"mean_ms", s.delays->meanLag()}, {"largest_ms", s.delays->largestLag()}};
}

Json energyJson(const EnergyVerdict& energy) {
  Json contacts = Json::array();
  for (const ContactEnergy& contact : energy.contacts)
    contacts.push_back({{"first", contact.first},
                        {"last", contact.last},
                        {"given_J", contact.along.work},
                        {"damped_J", contact.along.damped},
                        {"largest_force_N", contact.largest_force},
                        {"stalled", contact.stalled},
                        {"holds", contact.stalled ? Json(nullptr) : Json(contact.holds())}});
  return {{"holds", energy.holds()},
          {"given_J", energy.judged.work},
          {"damped_J", energy.judged.damped},
          {"given_with_stalls_J", energy.stalled.work},
          {"contacts", contacts}};
}

}  // namespace

std::string textOf(const Session& s) {
  const Recording& recording = s.recording;
  std::string text =
      printed("%s of a %s (%.3f kg, %.3f N s/m, %.2f N) held by a hand (%.3f kg, %.2f N s/m, %.0f N/m)\n",
              s.kind.c_str(), s.preset.c_str(), s.mechanics.mass, s.mechanics.damping, s.mechanics.friction,
              s.hand.mass, s.hand.damping, s.hand.stiffness);
  if (s.delays != nullptr)
    text += printed("answers delayed as in %s: %.2f ms in the mean, %zu ms at most\n", s.delay_from.c_str(),
                    s.delays->meanLag(), s.delays->largestLag());
  std::vector<double> t, depth;
  for (std::size_t i = 0; i < recording.trace.position.size(); ++i) {
    t.push_back(static_cast<double>(i) * recording.trace.dt);
    depth.push_back(std::max(0.0, 1e3 * depthOf(s.motion, recording.trace.position[i])));
  }
  text += report::textChart(t, depth, "s", "tip below the rest surface / mm") + '\n';
  text += printed("%s; %.2f s of the hold judged: oscillation %.4f mm (without organ %.4f mm); %s\n",
                  verdictText(s), s.verdict.judged_s, 1e3 * s.verdict.oscillation_pp,
                  1e3 * s.verdict.oscillation_without_organ_pp, settled(s.verdict).c_str());
  text += printed(
      "largest force %.4f N, penetration %.3f mm; work on the organ %.6f J in all; waited %llu ms; flags: ",
      s.verdict.max_force, 1e3 * largest(recording.penetration), recording.work.back(),
      static_cast<unsigned long long>(recording.waited));
  text += report::flagNames(recording.flags) + '\n';
  text += energyText(s.energy);
  text += client::modelChangesText(recording.model_changes);
  if (recording.server_left) text += "the server shut down before the motion's end\n";
  if (recording.interrupted) text += "interrupted before the motion's end\n";
  return text;
}

Json jsonOf(const Session& s) {
  const Recording& recording = s.recording;
  const Json settle = s.verdict.settle_s ? Json(*s.verdict.settle_s) : Json(nullptr);
  return {
      {"preset", s.preset},
      {"device",
       {{"mass", s.mechanics.mass}, {"damping", s.mechanics.damping}, {"friction", s.mechanics.friction}}},
      {"hand", {{"mass", s.hand.mass}, {"damping", s.hand.damping}, {"stiffness", s.hand.stiffness}}},
      {"motion", s.kind},
      {"seconds", s.motion.path.seconds()},
      {"hold_start_s", s.motion.hold_start},
      {"hold_end_s", s.motion.hold_end},
      {"node", s.spot.mesh_tag},
      {"position", s.spot.position},
      {"normal", s.spot.normal},
      {"model_id", s.server.surface.model_id},
      {"stable", s.stable()},
      {"judged", s.judged()},
      {"judged_s", s.verdict.judged_s},
      {"settle_s", settle},
      {"oscillation_pp_m", s.verdict.oscillation_pp},
      {"oscillation_without_organ_pp_m", s.verdict.oscillation_without_organ_pp},
      {"max_force_N", s.verdict.max_force},
      {"penetration_m", largest(recording.penetration)},
      {"depth_m", s.verdict.depth},
      {"energy_net_J", recording.work.back()},
      {"energy", energyJson(s.energy)},
      {"coupling_N_per_m", couplingOf(s.server.status)},
      {"server_device", std::string(s.server.status.device)},
      {"flags", recording.flags},
      {"flag_names", report::flagNames(recording.flags)},
      {"waited_periods", recording.waited},
      {"model_changes", recording.model_changes},
      {"delays", delaysJson(s)},
      {"server_left", recording.server_left},
      {"interrupted", recording.interrupted},
      {"tip_m", recording.trace.position},
      {"force_N", recording.trace.force},
      {"work_J", recording.work}};
}

std::string plotOf(const Session& s) {
  program::SvgPlot plot;
  plot.title = "palpate-device --preset " + s.preset + " --motion " + s.kind;
  plot.x_label = "time / s";
  plot.y_label = "tip below the rest surface / mm";
  const auto curve = [&](const char* name, const Trace& trace) {
    program::Series series{name, {}, {}, {}};
    for (std::size_t i = 0; i < trace.position.size(); ++i) {
      series.x.push_back(static_cast<double>(i) * trace.dt);
      series.y.push_back(1e3 * depthOf(s.motion, trace.position[i]));
    }
    plot.series.push_back(std::move(series));
  };
  curve("on the organ", s.recording.trace);
  curve("without it", s.without_organ);
  return plot.render();
}

}  // namespace palpate::device
