// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/config.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "core/devices/device_preset.h"
#include "palpate/rt/process_threads.h"

namespace palpate::server {
namespace {

struct Range {
  const char* key;
  double value;
  double low;
  double high;
  const char* unit;
};

std::string outOf(const Range& range) {
  std::ostringstream text;
  text.precision(10);
  text << "is " << range.value << ", expected " << range.low << " to " << range.high << range.unit;
  return text.str();
}

// The key of an engine's field in the file.
std::string keyOf(const std::string& field) {
  for (const LiveParameterInfo& info : kLiveParameters)
    if (field == info.name) return info.key;
  if (field == "tools") return field;
  if (const std::size_t dot = field.find('.'); dot != std::string::npos)  // a tool's own: "1.friction"
    return "tool." + field;
  return "tool." + field;
}

std::optional<Complaint> firstToolComplaint(const StepConfig& step) {
  const auto found = palpate::firstComplaint(step);
  if (!found) return std::nullopt;
  return Complaint{keyOf(found->field), found->text};
}

// A force is held for a period. If the period exceeds stale_timeout, the answer to a fresh pose goes stale.
std::optional<Complaint> rateComplaint(const ServerConfig& config) {
  constexpr double kRounding = 1e-9;
  const double slowest = 1.0 / config.step.stale_timeout;
  if (config.rate >= slowest * (1.0 - kRounding)) return std::nullopt;
  std::ostringstream text;
  text << "is " << config.rate << ", expected at least " << slowest
       << " Hz: a period has to fit into tool.stale_timeout, " << config.step.stale_timeout << " s";
  return Complaint{"rate", text.str()};
}

std::optional<Complaint> cpuComplaint(const ServerConfig& config) {
  if (config.tick_cpu == kAnyCpu) return std::nullopt;
  const std::vector<int> usable = rt::usableCpus();
  if (std::find(usable.begin(), usable.end(), config.tick_cpu) != usable.end()) return std::nullopt;
  return Complaint{"tick_cpu",
                   "is " + std::to_string(config.tick_cpu) +
                       ", expected one of the CPUs that this process may use: " + rt::cpuList(usable)};
}

std::string deviceNames() {
  std::string names;
  for (const DevicePreset& preset : devicePresets()) names += std::string(preset.name) + ", ";
  return names + "or " + std::string(kCustomDevice);
}

// A rendered stiffness that was named above what the device is given.
std::optional<Complaint> renderedComplaint(const ServerConfig& config, std::size_t tool) {
  const OwnOptions& own = config.own[tool];
  const auto named = own.rendered_stiffness ? own.rendered_stiffness : config.rendered_stiffness;
  const auto preset = findDevicePreset(deviceOf(config, tool));
  if (!named || !preset || *named <= preset->rendered_stiffness) return std::nullopt;
  const bool alone = own.device || own.rendered_stiffness;
  std::ostringstream text;
  text << "is " << *named << ", expected at most " << preset->rendered_stiffness << " N/m, what device "
       << preset->name << " is given (device custom has no such limit)";
  return Complaint{(alone ? "tool." + std::to_string(tool) : "tool") + ".rendered_stiffness", text.str()};
}

}  // namespace

StepConfig withDevice(StepConfig step, const std::string& device, const LiveOverrides& said,
                      std::optional<double> rendered) {
  const StepConfig own;
  step.force_limit = own.force_limit;
  step.coupling_stiffness = own.coupling_stiffness;
  step.coupling_damping = own.coupling_damping;
  step.rendered_stiffness = own.rendered_stiffness;
  if (const auto preset = findDevicePreset(device)) apply(*preset, step);
  if (rendered) {
    if (std::isfinite(step.rendered_stiffness) && std::isfinite(*rendered) && *rendered > 0.0)
      step.coupling_damping *= *rendered / step.rendered_stiffness;
    step.rendered_stiffness = *rendered;
  }
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    if (const auto& value = said.*kLiveFields<LiveOverrides>[i]) step.*kLiveFields<StepConfig>[i] = *value;
  if (said.coupling_stiffness && !rendered)
    step.rendered_stiffness = own.rendered_stiffness;  // it holds as it was named
  if (!said.coupling_damping)
    step.coupling_damping = std::min(step.coupling_damping, kLongestCouplingTime * step.coupling_stiffness);
  return step;
}

const std::string& deviceOf(const ServerConfig& config, std::size_t tool) {
  const std::optional<std::string>& own = config.own[tool].device;
  return own ? *own : config.device;
}

void settleTools(ServerConfig& config) {
  config.step = withDevice(config.step, config.device, config.said, config.rendered_stiffness);
  for (std::size_t tool = 0; tool < config.own.size(); ++tool) {
    const OwnOptions& own = config.own[tool];
    LiveOverrides said = config.said;
    for (const auto field : kLiveFields<LiveOverrides>)
      if (own.said.*field) said.*field = own.said.*field;
    const StepConfig alone =
        withDevice(config.step, deviceOf(config, tool), said,
                   own.rendered_stiffness ? own.rendered_stiffness : config.rendered_stiffness);
    config.step.own[tool] = {own.tip_radius.value_or(config.step.tip_radius), liveParameters(alone),
                             alone.rendered_stiffness};
  }
}

bool followsOrgan(const ToolSettings& settings) {
  return std::isfinite(settings.rendered_stiffness);
}

double stiffnessLimit(const std::string& device) {
  const auto preset = findDevicePreset(device);
  return preset ? preset->stiffness_limit : std::numeric_limits<double>::infinity();
}

void checkDevice(const std::string& word) {
  if (word == kCustomDevice || findDevicePreset(word)) return;
  throw ConfigError("is \"" + word + "\", expected " + deviceNames());
}

std::optional<Complaint> deviceComplaint(const ServerConfig& config) {
  for (std::size_t tool = 0; tool < config.own.size(); ++tool) {
    if (auto complaint = renderedComplaint(config, tool)) return complaint;
    const ToolSettings settings = toolSettings(config.step)[tool];
    const double stiffness = settings.live.coupling_stiffness;
    const std::string& device = deviceOf(config, tool);
    const double limit = stiffnessLimit(device);
    if (!(stiffness > limit) || followsOrgan(settings)) continue;
    const OwnOptions& own = config.own[tool];
    const bool alone = own.device || own.said.coupling_stiffness;
    std::ostringstream text;
    text << "is " << stiffness << ", expected at most " << limit << " N/m, what device " << device
         << " renders stably (device custom has no such limit)";
    return Complaint{(alone ? "tool." + std::to_string(tool) : "tool") + ".coupling_stiffness", text.str()};
  }
  return std::nullopt;
}

std::optional<Complaint> firstComplaint(const ServerConfig& config) {
  constexpr double kMaxId = 4294967295.0;
  constexpr double kMaxServerId = kMaxId - 1.0;  // the last is dds::kServerAny
  const std::array<Range, 6> ranges{{
      {"domain", static_cast<double>(config.domain), 0, 230, ""},
      {"rate", config.rate, 10, 10000, " Hz"},
      {"server_id", static_cast<double>(config.server_id), 0, kMaxServerId, ""},
      {"listen_first", config.listen_first, 0, 10, " s"},
      {"organ_id", static_cast<double>(config.organ_id), 0, kMaxId, ""},
      {"surface_rate", config.surface_rate, 0.1, kEveryTick, " Hz"},
  }};
  for (const Range& range : ranges) {
    // Written so that NaN complains too.
    if (!(range.value >= range.low && range.value <= range.high)) return Complaint{range.key, outOf(range)};
  }
  if (auto complaint = cpuComplaint(config)) return complaint;
  if (auto complaint = firstToolComplaint(config.step)) return complaint;
  return rateComplaint(config);
}

bool parseSwitch(const std::string& word) {
  if (word == "on") return true;
  if (word == "off") return false;
  throw ConfigError("is \"" + word + "\", expected on or off");
}

rt::RealtimePolicy parsePolicy(const std::string& word) {
  if (word == "require") return rt::RealtimePolicy::kRequire;
  if (word == "prefer") return rt::RealtimePolicy::kPrefer;
  if (word == "off") return rt::RealtimePolicy::kOff;
  throw ConfigError("is \"" + word + "\", expected require, prefer or off");
}

}  // namespace palpate::server
