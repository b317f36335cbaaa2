// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "palpate/core/device_preset.h"
#include "palpate/core/step_config.h"
#include "palpate/rt/scheduling.h"

namespace palpate::server {

/// The default device: its limits hold.
inline constexpr std::string_view kDefaultDevice = "touch";
/// No preset: the caller's own numbers, and no limit on the coupling.
inline constexpr std::string_view kCustomDevice = "custom";

/// Live parameters that the file or the command line named. They win over the device preset, in any order.
using LiveOverrides = LiveFields<std::optional<double>>;

/// `step` with the force limit and the coupling of a device, and what was named over both.
/// "custom" (or an unknown device) leaves StepConfig's own defaults under what was named. A device's damping is cut to
/// what a softer coupling that was named allows (kLongestCouplingTime).
[[nodiscard]] StepConfig withDevice(StepConfig step, const std::string& device, const LiveOverrides& said);

/// A surface rate: with each tick.
inline constexpr double kEveryTick = std::numeric_limits<double>::infinity();

/// The tick runs where the scheduler puts it.
inline constexpr std::int64_t kAnyCpu = -1;

/// The options of the server: defaults, then the file, then the command line.
struct ServerConfig {
  std::filesystem::path model;                               ///< model file; no default
  std::int64_t domain{0};                                    ///< DDS domain, in [0, 230]
  double rate{1000.0};                                       ///< ticks per second, Hz, in [10, 10000]
  rt::RealtimePolicy realtime{rt::RealtimePolicy::kPrefer};  ///< require, prefer or off
  std::int64_t server_id{0};                                 ///< key of ServerStatus, in [0, 2^32 - 1]
  std::int64_t organ_id{0};                                  ///< key of the surface topics, in [0, 2^32 - 1]
  double surface_rate{kEveryTick};     ///< surface fields per second, Hz, in [0.1, kEveryTick]
  bool phase_lock{false};              ///< ticks follow the poses' arrival
  std::int64_t tick_cpu{kAnyCpu};      ///< CPU of the tick, one that this process may use
  bool tick_cpu_alone{false};          ///< nothing else of this process runs there
  std::filesystem::path record;        ///< where to record the session; empty: nowhere. Command line only
  std::string device{kDefaultDevice};  ///< a preset of device_preset.h, or custom
  LiveOverrides said;                  ///< of the file and the command line
  /// parameters of the engine, the device's included: withDevice() was applied. [tool] and [organ] in the file
  StepConfig step{withDevice({}, std::string(kDefaultDevice), {})};
};

/// An unusable option. what() is one line: the place, the value found, what was expected.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What is wrong with one value.
struct Complaint {
  std::string key;   ///< as in the file, e.g. "tool.tip_radius"
  std::string text;  ///< e.g. "is 7, expected 10 to 10000 Hz"
};

/// @return the first value out of its range, if any. The loader checks the model file.
/// deviceComplaint() checks the coupling against the device, once file and command line are both read.
[[nodiscard]] std::optional<Complaint> firstComplaint(const ServerConfig& config);

/// @throw ConfigError naming the devices that are known
void checkDevice(const std::string& word);

/// @return the coupling's stiffness when it is above what the device renders stably
[[nodiscard]] std::optional<Complaint> deviceComplaint(const ServerConfig& config);

/// The largest coupling stiffness that a device allows, N/m; infinity for "custom".
[[nodiscard]] double stiffnessLimit(const std::string& device);

/// @throw ConfigError naming the words that are known
[[nodiscard]] rt::RealtimePolicy parsePolicy(const std::string& word);

}  // namespace palpate::server
