// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/studies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/devices/device_preset.h"
#include "core/devices/sim/delays.h"
#include "core/response/largest_stiffness.h"
#include "tools/examine/feel/loops.h"
#include "tools/examine/feel/press_places.h"
#include "tools/examine/feel/safe_coupling.h"
#include "tools/examine/feel/slides.h"
#include "tools/examine/feel/stability.h"
#include "tools/program/exit_code.h"
#include "tools/program/json.h"
#include "tools/program/printed.h"
#include "tools/program/write_file.h"

namespace palpate::feel {

namespace {

using program::Json;

constexpr std::array kFrictions{0.0, 0.05, 0.3};

void print(const Json& rows, bool json) {
  if (json) {
    std::cout << rows.dump(2, program::Keys::kAsWritten) << '\n';
    return;
  }
  if (rows.empty()) return;
  for (const auto& item : rows.front().members()) std::cout << item.key << '\t';
  std::cout << '\n';
  for (const Json& row : rows) {
    for (const auto& item : row.members()) std::cout << item.value << '\t';
    std::cout << '\n';
  }
}

/// Leaves out, and counts, the loops with a fixed anchor in which the tool was released on the way.
Json rowOf(const char* kind, double friction, std::vector<LoopResult> loops) {
  int releases = 0;
  for (const LoopResult& loop : loops) releases += loop.releases > 0 ? 1 : 0;
  const std::size_t count = loops.size();
  if (std::isinf(friction)) std::erase_if(loops, [](const LoopResult& loop) { return loop.releases > 0; });
  if (loops.empty())
    return {{"loops", kind},
            {"friction", friction},
            {"count", count},
            {"least_work_share", nullptr},
            {"largest_work_share", nullptr},
            {"with_release", releases}};
  const auto [least, most] = std::minmax_element(
      loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.share() < b.share(); });
  return {{"loops", kind},
          {"friction", friction},
          {"count", count},
          {"least_work_share", least->share()},
          {"largest_work_share", most->share()},
          {"with_release", releases}};
}

Json rowOf(double friction, const std::vector<SlideResult>& slides) {
  const auto worst = std::max_element(slides.begin(), slides.end(), [](const auto& a, const auto& b) {
    return a.largest_ratio < b.largest_ratio;
  });
  double lag = 0.0;
  int clicks = 0, later = 0, jumps = 0, releases = 0;
  for (const SlideResult& slide : slides) {
    lag = std::max(lag, slide.largest_lag);
    clicks += slide.largest_ratio > 1.0 ? 1 : 0;
    later += slide.largest_ratio_later > 1.0 ? 1 : 0;
    jumps += slide.largest_slow_step > 0.5 * slide.largest_step ? 1 : 0;
    releases += slide.releases > 0 ? 1 : 0;
  }
  return {{"friction", friction},
          {"count", slides.size()},
          {"clicks", clicks},
          {"clicks_after_3_mm", later},
          {"jumps", jumps},
          {"worst_step_share", worst->largest_ratio},
          {"worst_step_N", worst->largest_step},
          {"worst_median_step_N", worst->median_step},
          {"worst_mean_force_N", worst->mean_force},
          {"worst_lag", lag},
          {"with_release", releases}};
}

/// The place with the median normal stiffness of 99 random places.
ContactPoint ordinaryPlace(const MetaModel& model, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::pair<double, ContactPoint>> places;
  for (int i = 0; i < 99; ++i) {
    const ContactPoint s = randomContact(model, random);
    places.emplace_back(normalStiffness(model, s), s);
  }
  std::nth_element(places.begin(), places.begin() + 49, places.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return places[49].second;
}

// All of them, or the one that was asked for.
std::vector<DevicePreset> presetsOf(const Study& study) {
  if (const auto preset = findDevicePreset(study.preset)) return {*preset};
  return {devicePresets().begin(), devicePresets().end()};
}

std::array<double, 3> pointOf(const MetaModel& model, const ContactPoint& s) {
  const Vec3 X = model.surface().position(s);
  return {X.x(), X.y(), X.z()};
}

// Of palpate-device: its hand and friction where they are not what it takes with --delay-from.
std::string optionsOf(const StabilityCase& rings) {
  std::string text =
      program::printed(" --hand %g,%g,%g", rings.hand.mass, rings.hand.damping, rings.hand.stiffness);
  if (rings.friction) text += program::printed(" --friction %g", device::mechanicsOf(rings.preset).friction);
  return text;
}

// The command that found a coupling, and the one that tries it where it rings first.
std::vector<std::string> originOf(const Study& study, const MetaModel& model, const DevicePreset& preset,
                                  const SafeCoupling& safe) {
  std::vector<std::string> lines{"palpate-feel coupling " + study.model + " --delay-from " +
                                 study.delay_from};
  if (!safe.place) return lines;
  const std::array<double, 3> at = pointOf(model, safe.place->s);
  lines.push_back(program::printed(
      "rings from %.4g N/m, first at the %s place: palpate-device --preset %s --delay-from %s "
      "--at %.6g,%.6g,%.6g%s",
      safe.unstable_at, std::string(safe.place->name).c_str(), std::string(preset.name).c_str(),
      study.delay_from.c_str(), at[0], at[1], at[2], safe.rings ? optionsOf(*safe.rings).c_str() : ""));
  if (safe.rings)
    lines.push_back(program::printed(
        "that is on a server with --youngs-modulus %g, %s", safe.rings->youngs_modulus,
        safe.rings->first_delay == 0
            ? "with the delays from the beginning of the file; palpate-device takes their worst stretch"
            : "in the worst stretch of the delays, as palpate-device takes them"));
  return lines;
}

/// The largest coupling of each device under measured delays, as a table and as files.
int runSafeCoupling(const Study& study) {
  const device::Delays delays = device::Delays::read(study.delay_from);
  const MetaModel model = MetaModel::load(study.model);
  const std::vector<PressPlace> places = pressPlaces(model);
  const double organ_stiffness = largestStiffness(model);
  std::cerr << program::printed(
      "%s: %zu poses, %zu without an answer, %zu answers out of order; %zu periods of 1 ms, delay %.2f ms in "
      "the mean, "
      "%zu at most; %zu periods left out in which the server would fade the force\n",
      study.delay_from.c_str(), delays.poses(), delays.lost(), delays.reordered(), delays.size(),
      delays.meanLag(), delays.largestLag(), delays.stalled());
  std::cerr << delays.note();
  Json rows = Json::array();
  bool all = true;
  for (const DevicePreset& preset : presetsOf(study)) {
    const SafeCoupling safe = safeCoupling(model, delays, preset, places, organ_stiffness);
    const bool found = safe.rendered_stiffness > 0.0;
    all = all && found;
    rows.push_back(
        {{"preset", preset.name},
         {"safe_rendered_N_per_m", safe.rendered_stiffness},
         {"safe_damping_Ns_per_m", safe.damping},
         {"preset_rendered_N_per_m", preset.rendered_stiffness},
         {"largest_stable_N_per_m", safe.largest_stable},
         {"bound", safe.by_device ? "device" : "delays"},
         {"unstable_at_N_per_m", safe.by_device ? Json(nullptr) : Json(safe.unstable_at)},
         {"rings_at", safe.place ? Json(safe.place->name) : Json(nullptr)},
         {"rings_at_m", safe.place ? Json(pointOf(model, safe.place->s)) : Json(nullptr)},
         {"rings_with_hand_N_per_m", safe.rings ? Json(safe.rings->hand.stiffness) : Json(nullptr)},
         {"rings_with_friction", safe.rings ? Json(safe.rings->friction) : Json(nullptr)},
         {"mean_delay_ms", delays.meanLag()},
         {"largest_delay_ms", delays.largestLag()}});
    if (!study.json) std::cerr << rows.back() << '\n';
    if (study.settings.empty() || !found) continue;
    std::filesystem::create_directories(study.settings);
    program::writeFile(std::filesystem::path(study.settings) / (std::string(preset.name) + ".toml"),
                       settingOf(preset, safe, originOf(study, model, preset, safe)));
  }
  print(rows, study.json);
  return all ? program::kDone : program::kNotHeld;
}

}  // namespace

int runLoops(const Study& study) {
  const MetaModel model = MetaModel::load(study.model);
  const LoopOptions options{study.count, 1e-3, study.seed};
  Json rows = Json::array();
  rows.push_back(rowOf("held", INFINITY, heldLoops(model, options)));
  for (const double friction : kFrictions)
    rows.push_back(rowOf("sliding", friction, slidingLoops(model, options, study.depth, friction)));
  print(rows, study.json);
  return 0;
}

int runSlides(const Study& study) {
  const MetaModel model = MetaModel::load(study.model);
  Json rows = Json::array();
  for (const double friction : kFrictions) {
    SlideOptions options;
    options.paths = study.paths;
    options.depth = study.depth;
    options.speed = study.speed;
    options.seed = study.seed;
    options.friction = friction;
    rows.push_back(rowOf(friction, slides(model, options)));
  }
  print(rows, study.json);
  return 0;
}

int runCoupling(const Study& study) {
  if (!study.delay_from.empty()) return runSafeCoupling(study);
  const MetaModel model = MetaModel::load(study.model);
  const ContactPoint s = ordinaryPlace(model, study.seed);
  const double organ_stiffness = largestStiffness(model);
  Json rows = Json::array();
  for (const DevicePreset& preset : presetsOf(study))
    for (const double E : kModuli)
      for (const device::Hand& hand : kHands) {
        const StabilityCase which{preset, E, hand, s, organ_stiffness, !study.frictionless};
        const StabilityResult result = stability(model, which);
        const double coupling = defaultCoupling(model, which);
        rows.push_back({{"preset", preset.name},
                        {"E_Pa", E},
                        {"hand_N_per_m", hand.stiffness},
                        {"organ_N_per_m", organ_stiffness * E / model.attributes().E},
                        {"default_N_per_m", std::isinf(coupling) ? Json(nullptr) : Json(coupling)},
                        {"largest_stable_N_per_m", result.largest_stable},
                        {"stable", result.at_default.stable},
                        {"oscillation_pp_m", result.at_default.oscillation_pp},
                        {"max_force_N", result.at_default.max_force}});
        if (!study.json) std::cerr << rows.back() << '\n';
      }
  print(rows, study.json);
  return 0;
}

}  // namespace palpate::feel
