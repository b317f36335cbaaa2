// SPDX-License-Identifier: Apache-2.0
#include "tool_report.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "palpate/client/model_changes.h"
#include "palpate/report/program.h"
#include "palpate/report/text_chart.h"
#include "tools/program/printed.h"
#include "tools/program/svg_plot.h"

namespace palpate::tool {
namespace {

using device::Point;
using program::printed;

Point forceOf(const Sample& sample) {
  return {sample.force.force[0], sample.force.force[1], sample.force.force[2]};
}

// Depth of the tip below the undeformed surface at the spot, m.
double depthOf(const Played& played, const Sample& sample) {
  return played.options.tip_radius - dot(sample.pose - played.spot.position, played.spot.normal);
}

const Sample& peakOf(const Recording& recording) {
  return *std::max_element(
      recording.samples.begin(), recording.samples.end(),
      [](const Sample& a, const Sample& b) { return length(forceOf(a)) < length(forceOf(b)); });
}

std::uint32_t flagsOf(const Recording& recording) {
  std::uint32_t flags = 0;
  for (const Sample& sample : recording.samples) flags |= sample.force.flags;
  return flags;
}

std::string rowOf(const Played& played, const Sample& sample) {
  static constexpr std::array<const char*, 3> kStates{"free", "stick", "slide"};
  const Point f = forceOf(sample);
  const char* state = sample.force.state < kStates.size() ? kStates[sample.force.state] : "?";
  return printed("%7.3f  %-9s %8.3f  %8.4f %8.4f %8.4f  %8.4f  %-6s ", sample.t_s,
                 played.path.legAt(sample.t_s).c_str(), depthOf(played, sample) * 1e3, f[0], f[1], f[2],
                 length(f), state) +
         report::flagNames(sample.force.flags) + '\n';
}

std::string summaryOf(const Played& played, const Recording& recording) {
  const Sample& peak = peakOf(recording);
  return printed(
             "peak force %.4f N at %.3f s, %.3f mm deep; %llu poses sent, %llu answered, %llu superseded, "
             "%llu unanswered, %llu forces lost\n",
             length(forceOf(peak)), peak.t_s, depthOf(played, peak) * 1e3,
             static_cast<unsigned long long>(recording.sent),
             static_cast<unsigned long long>(recording.samples.size()),
             static_cast<unsigned long long>(recording.superseded()),
             static_cast<unsigned long long>(recording.unanswered()),
             static_cast<unsigned long long>(recording.answers.lost())) +
         recording.left_out_text + client::modelChangesText(recording.model_changes) +
         (recording.server_left ? "the server shut down before the script's end\n" : "");
}

// Work of the hand on the organ up to each sample, J: the integral of -force . d pose, by trapezoids.
std::vector<double> workOf(const Recording& recording) {
  std::vector<double> work;
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    if (i == 0) {
      work.push_back(0.0);
      continue;
    }
    const Sample& before = recording.samples[i - 1];
    const Sample& now = recording.samples[i];
    work.push_back(work.back() - 0.5 * dot(forceOf(before) + forceOf(now), now.pose - before.pose));
  }
  return work;
}

}  // namespace

std::string tableOf(const Played& played, const Recording& recording) {
  constexpr std::size_t kRows = 24;
  const Point& X = played.spot.position;
  std::string text = printed(
      "%s at node %lld (%.4f, %.4f, %.4f) m, tip radius %.1f mm, depth %.1f mm; force on the tool, world "
      "frame\n",
      played.script.c_str(), static_cast<long long>(played.spot.mesh_tag), X[0], X[1], X[2],
      played.options.tip_radius * 1e3, played.options.depth * 1e3);
  text += "   t / s  leg       depth/mm      fx/N     fy/N     fz/N     |f|/N  state  flags\n";
  const std::size_t count = recording.samples.size();
  for (std::size_t row = 0; row < std::min(kRows, count); ++row)
    text += rowOf(
        played, recording.samples[row * (count - 1) / std::max<std::size_t>(std::min(kRows, count) - 1, 1)]);
  std::vector<double> t, f;
  for (const Sample& sample : recording.samples) {
    t.push_back(sample.t_s);
    f.push_back(length(forceOf(sample)));
  }
  return text + '\n' + report::textChart(t, f, "s", "|force| / N") + '\n' + summaryOf(played, recording);
}

program::Json jsonOf(const Played& played, const Recording& recording) {
  program::Json t = program::Json::array(), pose = t, force = t, flags = t, penetration = t;
  double contact_s = 0.0;
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    const Sample& sample = recording.samples[i];
    t.push_back(sample.t_s);
    pose.push_back(sample.pose);
    force.push_back(forceOf(sample));
    flags.push_back(sample.force.flags);
    penetration.push_back(sample.force.penetration);
    if (i > 0 && (sample.force.flags & dds::flag::kInContact) != 0)
      contact_s += sample.t_s - recording.samples[i - 1].t_s;
  }
  const Sample& peak = peakOf(recording);
  return {{"script", played.script},
          {"model_id", played.server.surface.model_id},
          {"tip_radius", played.options.tip_radius},
          {"depth", played.options.depth},
          {"node", played.spot.mesh_tag},
          {"position", played.spot.position},
          {"normal", played.spot.normal},
          {"seconds", played.path.seconds()},
          {"t_s", t},
          {"pose_m", pose},
          {"force_N", force},
          {"flags", flags},
          {"penetration_m", penetration},
          {"work_J", workOf(recording)},
          {"summary",
           {{"peak_force_N", length(forceOf(peak))},
            {"peak_force_vector_N", forceOf(peak)},
            {"peak_t_s", peak.t_s},
            {"peak_depth_m", depthOf(played, peak)},
            {"contact_s", contact_s},
            {"sent", recording.sent},
            {"answered", recording.samples.size()},
            {"superseded", recording.superseded()},
            {"unanswered", recording.unanswered()},
            {"received", recording.answers.received()},
            {"lost", recording.answers.lost()},
            {"left_out", recording.left_out.count},
            {"model_changes", recording.model_changes},
            {"missed_periods", recording.missed_periods},
            {"server_left", recording.server_left},
            {"flags_seen", report::flagNames(flagsOf(recording))}}}};
}

std::string plotOf(const Played& played, const Recording& recording) {
  program::SvgPlot plot;
  plot.title = "palpate-tool --script " + played.script + ": force on the tool";
  plot.x_label = "time / s";
  plot.y_label = "force / N";
  plot.series = {{"|f|", {}, {}, {}}, {"f x", {}, {}, {}}, {"f y", {}, {}, {}}, {"f z", {}, {}, {}}};
  for (const Sample& sample : recording.samples) {
    const Point f = forceOf(sample);
    const std::array<double, 4> values{length(f), f[0], f[1], f[2]};
    for (std::size_t i = 0; i < values.size(); ++i) {
      plot.series[i].x.push_back(sample.t_s);
      plot.series[i].y.push_back(values[i]);
    }
  }
  return plot.render();
}

std::string comparisonOf(const Recording& recording, const Recording& beside) {
  const double here = length(forceOf(peakOf(recording))), there = length(forceOf(peakOf(beside)));
  return printed("peak force %.4f N here, %.4f N beside: ", here, there) +
         (there > 0.0 ? printed("%+.1f %%\n", 100.0 * (here / there - 1.0)) : "no force beside\n");
}

std::string plotOfBoth(const Played& played, const Recording& recording, const Played& other,
                       const Recording& beside) {
  program::SvgPlot plot;
  plot.title = "palpate-tool --script " + played.script + ": size of the force on the tool";
  plot.x_label = "depth / mm";
  plot.y_label = "force / N";
  for (const auto& [name, path, answers] :
       {std::tuple("here", &played, &recording), std::tuple("beside", &other, &beside)}) {
    program::Series& curve = plot.series.emplace_back();
    curve.name = printed("%s, node %lld", name, static_cast<long long>(path->spot.mesh_tag));
    for (const Sample& sample : answers->samples) {
      if (depthOf(*path, sample) < 0.0) continue;
      curve.x.push_back(depthOf(*path, sample) * 1e3);
      curve.y.push_back(length(forceOf(sample)));
    }
  }
  return plot.render();
}

}  // namespace palpate::tool
