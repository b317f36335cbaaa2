// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "palpate/haptic/force.h"

#if defined(__GNUC__)
#define PALPATE_HAPTIC_API __attribute__((visibility("default")))
#else
#define PALPATE_HAPTIC_API
#endif

/// What a device driver links (find_package(palpate), target palpate::haptic): it sends the tool's pose and reads the
/// force on it. palpate_haptic.h offers the same to C. SI units; world frame W is that of the organ's mesh.
namespace palpate::haptic {

using Quaternion = std::array<double, 4>;  ///< x, y, z, w, unit length

/// What failed and why, in one line. Only HapticTool's constructor throws it.
class PALPATE_HAPTIC_API HapticError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr std::uint32_t kAnyServer = 0xFFFFFFFF;

struct Options {
  std::uint32_t domain{0};              ///< DDS domain, 0 to 230, the server's
  std::uint32_t server_id{kAnyServer};  ///< the server; kAnyServer: the first that answers
  std::uint32_t tool_id{0};             ///< 0 to 3; each driver needs its own
  /// Largest force that the device renders, N, in [0.01, 50]. It has no default: only the driver knows its device. The server's
  /// limit applies too, once its status has come.
  double force_limit{0.0};
  /// Distance from the answered pose up to which a force is extrapolated, m, in [0, 0.05]; beyond it the force stays
  /// constant. 0: never. 2 mm are 2 ms at 1 m/s.
  double max_extrapolation{0.002};
  int receive_priority{0};  ///< SCHED_FIFO priority of the receiving threads, 1 to 99; 0: unchanged
  /// As in palpate-server --device: its limits hold for this tool where they are lower. Empty: none said
  std::string device{};
  /// The server of this organ, by the id that the server gave it (palpate-server --organ-id), 0 to 4294967295; empty: of any. With it
  /// no pose goes out until that server's status has come, within a second.
  std::optional<std::int64_t> organ_id{};
  /// Folder with the identity of a driver (palpate-security issue driver NAME), where topics are signed and encrypted
  /// (docs/security.md). Empty: they are not
  std::string security{};
};

/// One tool of one server. It holds on to one run of one server: the first that answers, or that of `server_id`. Forces of other
/// servers never reach the device. When the held server was silent for a second, or 100 ms after it said that it stops, the next
/// may be held on to; the force is zero by then and rises from there. Force::session tells.
///
/// Watchdog, by this machine's clock: 20 ms after the newest answer the force at the device begins to fall; 30 ms later it is
/// zero, when it is read every 5 ms or more often. When answers come or come back, the force rises within 30 ms. After 50 ms
/// without a read it is zero until a later pose is answered. Answers that arrive more than 50 ms after their pose was sent are ignored. The watchdog acts when the caller reads: a driver that stops
/// reading must release its device itself.
///
/// Threads: one thread sends and reads. The library receives answers on its own thread.
/// Real-time: reading yes. Sending: no allocation of ours; Cyclone DDS locks and may allocate in its write
/// (clients/haptic/README.md has figures).
class PALPATE_HAPTIC_API HapticTool {
 public:
  /// Joins the domain; does not wait for a server.
  /// @throw HapticError naming the field out of its range, its value and the range; or what DDS refused
  explicit HapticTool(const Options& options);
  HapticTool(HapticTool&& other) noexcept;
  HapticTool& operator=(HapticTool&& other) noexcept;
  ~HapticTool();

  /// @return whether, within `timeout`, a server takes poses and sends forces. Real-time: no
  [[nodiscard]] bool waitForServer(std::chrono::milliseconds timeout) const noexcept;

  /// Sends the current pose. Call it at 1 kHz or faster: each tick the server answers the newest pose.
  /// @param[in] position     p_WT, centre of the tip, m
  /// @param[in] orientation  q_WT
  /// @param[in] buttons      bit i: button i is held down
  /// @return the pose's number, 0 when DDS refused it, or while no server of `organ_id` is known
  /// A pose that is not finite is sent too: the server answers with a flag and a force that fades.
  std::uint64_t send(const Vec3& position, const Quaternion& orientation = {0.0, 0.0, 0.0, 1.0},
                     std::uint32_t buttons = 0) noexcept;

  /// The newest force, held until the next answer.
  [[nodiscard]] Force force() noexcept;

  /// The newest force, extrapolated to the tool's current position:
  ///   force + stiffness (p - p_answered)
  /// p_answered is the pose that the force answers, one or two milliseconds old, `stiffness` its ToolForce::stiffness.
  ///   distance  |p - p_answered| counts as at most max_extrapolation
  ///   no push   the change of the force has no part along the tool's motion: a stiffness that would pull the tool
  ///             onwards is left out
  ///   no pull   the result has no part against the answered force: a push never turns into a pull
  ///   limit     |result| is at most the limits
  /// Each bound is continuous in p. When the answered pose is unknown (more than 1024 poses ago, or not finite), the
  /// result is force().
  /// @param[in] position  current p_WT, m
  [[nodiscard]] Force forceAt(const Vec3& position) noexcept;

  /// Forces of other servers for this tool that were left out so far. Not 0: stop one of the servers.
  [[nodiscard]] std::uint64_t leftOut() const noexcept;

  /// Reads whose newest answer was ignored, since it arrived more than 50 ms after its pose was sent: some after a pause of driver or
  /// server; where they grow with each read, the network is too slow for a force. From the thread that reads.
  [[nodiscard]] std::uint64_t tooLate() const noexcept;

  /// How near the tip's centre came to the organ at rest, m: 0 once it touched it, infinity before the first answer. For a line at a
  /// driver's end: poses in millimetres never come near.
  [[nodiscard]] double nearest() const noexcept;

  /// The tip radius that the server assumes, m, and its force limit, N; 0 until its status has come.
  [[nodiscard]] double tipRadius() const noexcept;
  [[nodiscard]] double serverForceLimit() const noexcept;

  /// One line for who runs the driver, from 30 days before the identity in Options::security ends; else empty. Real-time: no
  [[nodiscard]] std::string securityWarning() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::haptic
