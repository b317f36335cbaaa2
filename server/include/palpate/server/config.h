// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/tick/apply_preset.h"
#include "core/tick/step_config.h"
#include "palpate/rt/scheduling.h"

namespace palpate::server {

/// The default device: its limits hold.
inline constexpr std::string_view kDefaultDevice = "touch";
/// No preset: the caller's own numbers, and no limit on the coupling.
inline constexpr std::string_view kCustomDevice = "custom";

/// Live parameters that the file or the command line named. They win over the device preset, in any order.
using LiveOverrides = LiveFields<std::optional<double>>;

/// What one tool has of its own, as the file and the command line named it.
struct OwnOptions {
  std::optional<std::string> device;
  std::optional<double> tip_radius;          ///< m
  std::optional<double> rendered_stiffness;  ///< N/m
  LiveOverrides said;                        ///< E is not looked at: it is the organ's
};

/// Lowest and highest value that a request may set while the server runs.
struct Bounds {
  double low;
  double high;
};
/// Those that the file or the command line named.
using LiveBounds = LiveFields<std::optional<Bounds>>;

/// `step` with the force limit and the coupling of a device, and what was named over both.
/// "custom" (or an unknown device) leaves StepConfig's own defaults under what was named. A coupling that was named does not
/// follow the organ. A device's damping is cut to what a softer one allows (kLongestCouplingTime).
/// @param[in] rendered  what organ and coupling in series render at most, N/m, and the device's damping in proportion; nothing:
///                      the device's
[[nodiscard]] StepConfig withDevice(StepConfig step, const std::string& device, const LiveOverrides& said,
                                    std::optional<double> rendered = std::nullopt);

/// A surface rate: with each tick.
inline constexpr double kEveryTick = std::numeric_limits<double>::infinity();

/// The tick runs where the scheduler puts it.
inline constexpr std::int64_t kAnyCpu = -1;

/// The options of the server: defaults, then the file, then the command line.
struct ServerConfig {
  std::filesystem::path model;   ///< model file; no default
  std::filesystem::path models;  ///< folder whose models clients may ask for; empty: they may not
  std::int64_t domain{0};        ///< DDS domain, in [0, 230]
  std::filesystem::path
      security;         ///< folder of the server's identity; empty: topics are neither signed nor encrypted
  double rate{1000.0};  ///< ticks per second, Hz, in [10, 10000]
  rt::RealtimePolicy realtime{rt::RealtimePolicy::kPrefer};  ///< require, prefer or off
  std::int64_t server_id{0};           ///< names it in poses and answers, in [0, 2^32 - 2]
  bool addressed_only{false};          ///< poses for any server are left to others
  double listen_first{0.5};            ///< for other servers before the first force, s, in [0, 10]; 0: not
  std::int64_t organ_id{0};            ///< key of the surface topics, in [0, 2^32 - 1]
  double surface_rate{1000.0};         ///< surface fields per second at most, Hz, in [0.1, kEveryTick]
  bool phase_lock{false};              ///< ticks follow the poses' arrival
  std::int64_t tick_cpu{kAnyCpu};      ///< CPU of the tick, one that this process may use
  bool tick_cpu_alone{false};          ///< nothing else of this process runs there
  bool check_realtime{false};          ///< say how the machine suits, and end. Command line only
  bool json{false};                    ///< as JSON. Command line only
  std::filesystem::path record;        ///< where to record the session; empty: nowhere. Command line only
  std::string device{kDefaultDevice};  ///< a preset of device_preset.h, or custom
  LiveOverrides said;                  ///< of the file and the command line
  std::optional<double> rendered_stiffness;  ///< of organ and coupling in series at most, N/m; the file's
  bool parameters{true};                     ///< requests may change live parameters
  LiveBounds limits;                         ///< within these; what is not named: liveLimits()
  std::optional<Bounds>
      tip_limits;  ///< of the tip that a driver may name, m: [limits] tip_radius; tipLimits()
  /// parameters of the engine, the device's included: withDevice() was applied. [tool] and [organ] in the file
  StepConfig step{withDevice({}, std::string(kDefaultDevice), {})};
  std::array<OwnOptions, kMaxTools> own;  ///< by tool; what is named there wins over the above. [tool.N]
};

/// The device of a tool.
[[nodiscard]] const std::string& deviceOf(const ServerConfig& config, std::size_t tool);

/// Sets the step's settings from the device and what was named: for all tools, then for those that have something of their
/// own. What was named for all tools wins over a tool's own device.
void settleTools(ServerConfig& config);

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

/// Whether organ and device choose the coupling, within what was asked for: no stiffness was named.
[[nodiscard]] bool followsOrgan(const ToolSettings& settings);

/// @return the coupling's stiffness when one was named above what the device renders stably, or a rendered one above the device's
[[nodiscard]] std::optional<Complaint> deviceComplaint(const ServerConfig& config);

/// The largest coupling stiffness that a device allows, N/m; infinity for "custom".
[[nodiscard]] double stiffnessLimit(const std::string& device);

/// @throw ConfigError naming the words that are known: on, off
[[nodiscard]] bool parseSwitch(const std::string& word);

/// @throw ConfigError naming the words that are known
[[nodiscard]] rt::RealtimePolicy parsePolicy(const std::string& word);

}  // namespace palpate::server
