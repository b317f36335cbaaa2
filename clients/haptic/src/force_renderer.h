// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "core/devices/path/path.h"
#include "palpate/haptic/force.h"

namespace palpate::haptic {

using device::Point;

/// The parts of a ToolForce that are rendered. Plain data: it crosses threads.
struct Answer {
  Vec3 force{};                       ///< N
  std::array<double, 9> stiffness{};  ///< d force_i / d position_j, row-major, N/m
  Vec3 anchor{};
  Vec3 proxy{};
  std::uint64_t pose_seq{0};
  std::uint32_t flags{0};
  std::uint32_t state{0};
  std::int64_t arrived_ns{0};  ///< this machine's clock
  std::int64_t first_arrived_ns{
      0};  ///< of the first answer to this pose: a server repeats it until there is a newer one
  std::uint32_t server_id{0};
  std::uint64_t session{0};
};

/// Turns answers into the current force: watchdog, extrapolation, limits (haptic_tool.h). Knows neither DDS nor a clock: the
/// caller passes the time. Threads: one. Real-time: yes.
class ForceRenderer {
 public:
  static constexpr double kStaleAfter = 0.020;  ///< s without an answer until the force falls
  static constexpr double kRamp = 0.030;        ///< s from full force to none, and back
  static constexpr std::int64_t kTooLate =
      50'000'000;  ///< ns from a pose to its first answer; what arrives later is ignored
  static constexpr double kLongestRead =
      0.005;  ///< s; of the time between two reads, what counts: in a rise of the force, and as the time it is rendered for
  static constexpr std::size_t kPoses = 1024;  ///< remembered poses; a quarter of a second at 4 kHz

  /// @param[in] max_extrapolation  m
  explicit ForceRenderer(double max_extrapolation) noexcept : max_extrapolation_(max_extrapolation) {}

  /// @param[in] seq  rises by one with each pose  @param[in] sent_ns  when, on this machine's clock
  void sent(std::uint64_t seq, const Point& position, std::int64_t sent_ns) noexcept PALPATE_NONBLOCKING;

  /// The force of another session rises from zero.
  /// @return false when it is ignored: a number is not finite, the pose is older than that of the last answer, or its first answer arrived
  /// more than kTooLate after it was sent
  bool answered(const Answer& answer) noexcept PALPATE_NONBLOCKING;

  /// The current force. The device renders it until its next read, which is taken to be as far off as the last one: by then it has
  /// fallen far enough. After kStaleAfter + kRamp without a read it is zero, and rises once an answer to a later pose has come.
  /// @param[in] position  of the tool; null: the answered force is held
  /// @param[in] limit     of the force's size, N
  [[nodiscard]] Force at(const Point* position, std::int64_t now_ns,
                         double limit) noexcept PALPATE_NONBLOCKING;

  /// How near the organ answered poses came, m: 0 after a contact, infinity before an answer to a remembered pose.
  [[nodiscard]] double nearest() const noexcept PALPATE_NONBLOCKING { return nearest_; }

  /// Calls of answered() with an answer that arrived more than kTooLate after its pose was sent.
  [[nodiscard]] std::uint64_t tooLate() const noexcept PALPATE_NONBLOCKING { return too_late_; }

 private:
  struct SentPose {
    std::uint64_t seq{0};
    Point position{};
    std::int64_t sent_ns{0};
  };

  [[nodiscard]] Point extrapolated(const Point& position) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool isTooLate(const Answer& answer) const noexcept PALPATE_NONBLOCKING;
  void comeNear() noexcept PALPATE_NONBLOCKING;
  void watch(std::int64_t now_ns) noexcept PALPATE_NONBLOCKING;

  double max_extrapolation_;
  std::array<SentPose, kPoses> poses_{};  // by seq modulo kPoses
  Answer answer_{};
  bool has_answer_{false};
  double age_{0.0};  // s
  double gain_{0.0};
  std::uint64_t newest_sent_{0};
  std::uint64_t too_late_{0};
  std::uint64_t rises_from_{0};  // the answered pose from which on the force may rise
  double nearest_{std::numeric_limits<double>::infinity()};  // m
  std::int64_t read_ns_{0};                                  // when at() was called last; 0: never
};

}  // namespace palpate::haptic
