// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/live_limits.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <sstream>

namespace palpate::server {
namespace {

std::string describe(const Bounds& bounds, const char* unit) {
  std::ostringstream text;
  text << bounds.low << " to " << bounds.high << (*unit == '\0' ? "" : " ") << unit;
  return text.str();
}

// The largest range that may be named. A coupling that does not follow the organ is never stiffer than the device renders
// stably.
Bounds widest(const LiveParameterInfo& info, const std::string& device, const ToolSettings& start) {
  Bounds all{info.low, info.may_be_infinite ? std::numeric_limits<double>::infinity() : info.high};
  if (info.bit == dds::parameter::kCouplingStiffness && !followsOrgan(start))
    all.high = std::min(all.high, stiffnessLimit(device));
  return all;
}

bool isBeyond(const Bounds& named, const LiveParameterInfo& info, const Bounds& all) {
  const bool between = named.high > info.high && named.high < std::numeric_limits<double>::infinity();
  return !(all.low <= named.low && named.low <= named.high && named.high <= all.high) || between;
}

}  // namespace

LiveParameters asFelt(const ToolSettings& settings, const OrganStiffness& organ) noexcept {
  LiveParameters live = settings.live;
  if (live.youngs_modulus == 0.0) live.youngs_modulus = organ.youngs_modulus;
  live.coupling_stiffness =
      1.0 / couplingCompliance(1.0 / live.coupling_stiffness, 1.0 / settings.rendered_stiffness, organ,
                               live.youngs_modulus);
  return live;
}

LiveLimits liveLimits(const LiveParameters& start, const LiveBounds& named) {
  LiveLimits limits;
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const auto field = kLiveFields<LiveParameters>[i];
    const Bounds own{std::min(kLiveParameters[i].low, start.*field), start.*field};
    const Bounds bounds = (named.*kLiveFields<LiveBounds>[i]).value_or(own);
    limits.lowest.*field = bounds.low;
    limits.highest.*field = bounds.high;
  }
  return limits;
}

Bounds tipLimits(double start, const std::optional<Bounds>& named) noexcept {
  constexpr double kMostRatio = 2.0;
  return named.value_or(Bounds{start / kMostRatio, start * kMostRatio});
}

namespace {

std::optional<Complaint> tipComplaint(const ServerConfig& config) {
  constexpr Bounds kAll{0.0, 0.05};  // of StepConfig::tip_radius
  if (!config.tip_limits) return std::nullopt;
  const Bounds& named = *config.tip_limits;
  const std::string key = "limits.tip_radius", found = "is " + describe(named, "m");
  if (!(kAll.low <= named.low && named.low <= named.high && named.high <= kAll.high))
    return Complaint{key, found + ", expected a range within " + describe(kAll, "m")};
  for (const ToolSettings& tool : toolSettings(config.step)) {
    if (named.low <= tool.tip_radius && tool.tip_radius <= named.high) continue;
    std::ostringstream text;
    text << found << ", which leaves out the start's " << tool.tip_radius;
    return Complaint{key, text.str()};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Complaint> limitsComplaint(const ServerConfig& config) {
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const LiveParameterInfo& info = kLiveParameters[i];
    const std::optional<Bounds>& named = config.limits.*kLiveFields<LiveBounds>[i];
    if (!named) continue;
    const std::string key = std::string("limits.") + info.name, found = "is " + describe(*named, info.unit);
    for (std::size_t tool = 0; tool < config.own.size(); ++tool) {
      const ToolSettings settings = toolSettings(config.step)[tool];
      const Bounds all = widest(info, deviceOf(config, tool), settings);
      if (isBeyond(*named, info, all))
        return Complaint{key, found + ", expected a range within " + describe(all, info.unit)};
      const double start = settings.live.*kLiveFields<LiveParameters>[i];
      const bool models = info.zero_is_models && start == 0.0;
      if (models || (named->low <= start && start <= named->high)) continue;
      std::ostringstream text;
      text << found << ", which leaves out the start's " << start;
      return Complaint{key, text.str()};
    }
  }
  return tipComplaint(config);
}

}  // namespace palpate::server
