// SPDX-License-Identifier: Apache-2.0
#include "core/tick/step_config.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

namespace palpate {

namespace {

enum class Infinity { kRefused, kMeansOff };

struct Range {
  const char* field;
  double value;
  double low;
  double high;
  std::string unit;
  Infinity infinity{Infinity::kRefused};
};

using Found = std::optional<FieldComplaint>;

Found complaintOf(const Range& range) {
  const bool off = range.infinity == Infinity::kMeansOff;
  if (range.value >= range.low && range.value <= range.high) return {};  // false for NaN too
  if (off && range.value == std::numeric_limits<double>::infinity()) return {};
  std::ostringstream text;
  text << "is " << range.value << ", expected " << range.low << " to " << range.high << " " << range.unit
       << (off ? " or infinity" : "");
  return FieldComplaint{range.field, text.str()};
}

// @param stiffness  the softest that the coupling gets, N/m
Found dampingComplaint(const LiveParameters& parameters, double stiffness) {
  const double most = kLongestCouplingTime * stiffness;
  if (parameters.coupling_damping <= most * (1.0 + 1e-9))
    return {};  // so that 1.5 of 300 counts as 5 ms despite rounding
  std::ostringstream text;
  text << "is " << parameters.coupling_damping << ", expected at most " << most
       << " N s/m with coupling_stiffness " << stiffness << " N/m: " << 1e3 * kLongestCouplingTime
       << " ms of it";
  return FieldComplaint{"coupling_damping", text.str()};
}

Found firstOf(std::initializer_list<Range> ranges) {
  for (const Range& range : ranges)
    if (auto found = complaintOf(range)) return found;
  return {};
}

// Of a StepConfig or the settings of a tool.
template <class Settings>
Range rendered(const Settings& settings) {
  return {"rendered_stiffness", settings.rendered_stiffness, 1.0, 1e5, "N/m", Infinity::kMeansOff};
}

}  // namespace

std::optional<FieldComplaint> firstComplaint(const LiveParameters& parameters, double rendered_stiffness) {
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const LiveParameterInfo& info = kLiveParameters[i];
    const double value = parameters.*kLiveFields<LiveParameters>[i];
    if (info.zero_is_models && value == 0.0) continue;
    const std::string unit = *info.unit == '\0' ? "(no unit)" : info.unit;
    auto found =
        complaintOf({info.name, value, info.low, info.high, info.zero_is_models ? unit + ", or 0" : unit,
                     info.may_be_infinite ? Infinity::kMeansOff : Infinity::kRefused});
    if (found) return found;
  }
  return dampingComplaint(parameters, std::min(parameters.coupling_stiffness, rendered_stiffness));
}

std::optional<FieldComplaint> firstComplaint(const ToolSettings& settings) {
  if (auto found = firstOf({{"tip_radius", settings.tip_radius, 0.0, 0.05, "m"}, rendered(settings)}))
    return found;
  return firstComplaint(settings.live, settings.rendered_stiffness);
}

std::optional<FieldComplaint> firstComplaint(const StepConfig& config) {
  if (auto found = firstOf({{"tip_radius", config.tip_radius, 0.0, 0.05, "m"},
                            {"stale_timeout", config.stale_timeout, 0.001, 0.045, "s"},
                            {"zero_after", config.zero_after, config.stale_timeout + 0.001, 0.050, "s"},
                            {"ramp_time", config.ramp_time, 0.0, 1.0, "s"},
                            {"quaternion_tolerance", config.quaternion_tolerance, 1e-9, 0.1, "(no unit)"},
                            {"organ_stiffness", config.organ_stiffness, std::numeric_limits<double>::min(),
                             std::numeric_limits<double>::max(), "N/m", Infinity::kMeansOff},
                            rendered(config)}))
    return found;
  if (auto found = firstComplaint(liveParameters(config), config.rendered_stiffness)) return found;
  for (std::size_t i = 0; i < config.own.size(); ++i) {
    auto found = firstComplaint(toolSettings(config)[i]);
    if (found) return FieldComplaint{std::to_string(i) + "." + found->field, found->text};
  }
  return firstOf({{"speed_limit", config.speed_limit, 0.01, 100.0, "m/s", Infinity::kMeansOff},
                  {"tools", static_cast<double>(config.tools), 1, kMaxTools, ""}});
}

LiveParameters liveParameters(const StepConfig& config) noexcept {
  LiveParameters live;
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    live.*kLiveFields<LiveParameters>[i] = config.*kLiveFields<StepConfig>[i];
  return live;
}

AllToolSettings toolSettings(const StepConfig& config) noexcept {
  AllToolSettings all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = config.own[i].value_or(
        ToolSettings{config.tip_radius, liveParameters(config), config.rendered_stiffness});
    all[i].live.youngs_modulus = config.youngs_modulus;
  }
  return all;
}

void check(const StepConfig& config) {
  if (const auto found = firstComplaint(config))
    throw std::invalid_argument("StepConfig." + found->sentence());
}

}  // namespace palpate
