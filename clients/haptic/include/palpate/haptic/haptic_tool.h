// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>

#if defined(__GNUC__)
#define PALPATE_HAPTIC_API __attribute__((visibility("default")))
#else
#define PALPATE_HAPTIC_API
#endif

/// What a device driver links (find_package(palpate), target palpate::haptic): send the tool's pose, read the force
/// on it. palpate_haptic.h is the same for C. SI units; world frame W: that of the organ's mesh.
namespace palpate::haptic {

using Vec3 = std::array<double, 3>;        ///< x, y, z in W
using Quaternion = std::array<double, 4>;  ///< x, y, z, w, unit length

/// What cannot be done and why, in one line. Thrown by HapticTool's constructor only.
class PALPATE_HAPTIC_API HapticError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Options {
  std::uint32_t domain{0};   ///< DDS domain, 0 to 230, the server's
  std::uint32_t tool_id{0};  ///< 0 to 3, one driver for each
  /// The device's own limit of the force, N, in [0.01, 50]. The server's holds as well, once its status has come.
  double force_limit{50.0};
  /// How far from the answered pose a force is extrapolated, m, in [0, 0.05]; farther, the force is that at this
  /// distance. 0: never. 2 mm are 2 ms at 1 m/s.
  double max_extrapolation{0.002};
  int receive_priority{0};  ///< SCHED_FIFO priority of the threads that receive, 1 to 99; 0: as it is
};

/// The force on the tool at one moment, and what belongs to it.
struct Force {
  Vec3 force{};       ///< on the tool in W, N: what the device renders. Never longer than the limits
  Vec3 anchor{};      ///< X(s): rest position of the material point that is touched, m
  Vec3 proxy{};       ///< where that point is now, m: draw the tool resting here
  double age_s{0.0};  ///< since the newest answer came, s; infinity before the first one
  double gain{0.0};   ///< of the watchdog, 0 to 1, contained in `force`
  std::uint64_t pose_seq{
      0};                  ///< the pose that was answered, as send() returned it; 0 before the first answer
  std::uint32_t flags{0};  ///< FLAG_* of palpate.idl, PALPATE_HAPTIC_FLAG_* of palpate_haptic.h
  std::uint32_t state{0};  ///< 0 free, 1 stick, 2 slide
};

/// One tool of one server.
///
/// Watchdog, by this machine's clock: 20 ms after the newest answer the force begins to fall and is zero another 30 ms
/// later; when answers come (back), it rises within 30 ms. It acts when the caller reads: a driver that stops
/// reading must let its device go limp by itself.
///
/// Threads: one thread sends and reads. Answers are received on a thread of the library's own.
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

  /// @return whether a server takes poses and sends forces, within `timeout`. Real-time: no
  [[nodiscard]] bool waitForServer(std::chrono::milliseconds timeout) const noexcept;

  /// Sends the pose of now. At 1 kHz or faster: the server answers the newest one each tick.
  /// @param[in] position     p_WT, centre of the tip, m
  /// @param[in] orientation  q_WT
  /// @param[in] buttons      bit i: button i is held down
  /// @return the pose's number, 0 when DDS refused it
  /// What is not finite is sent too: the server answers with a flag and lets the force go.
  std::uint64_t send(const Vec3& position, const Quaternion& orientation = {0.0, 0.0, 0.0, 1.0},
                     std::uint32_t buttons = 0) noexcept;

  /// The newest force, held.
  [[nodiscard]] Force force() noexcept;

  /// The newest force, carried on to where the tool is now:
  ///   force + stiffness (p - p_answered)
  /// p_answered is the pose that the force answers, one or two milliseconds old, `stiffness` its ToolForce::stiffness.
  ///   distance  |p - p_answered| is taken as at most max_extrapolation
  ///   no push   the change of the force never has a part along the way the tool went: stiffness that would pull the
  ///             tool on is left out
  ///   no pull   the result never has a part against the answered force: what pushed does not begin to pull
  ///   limit     |result| is at most the limits
  /// Each bound is continuous in p. Without an answered pose to start from (older than 1024 poses, not
  /// finite) it is force().
  /// @param[in] position  p_WT now, m
  [[nodiscard]] Force forceAt(const Vec3& position) noexcept;

  /// The tip's radius that the server assumes, m, and the limit of its force, N; 0 until its status has come.
  [[nodiscard]] double tipRadius() const noexcept;
  [[nodiscard]] double serverForceLimit() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::haptic
