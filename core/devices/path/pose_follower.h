// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/devices/path/path.h"

namespace palpate::device {

/// Turns a page's targets, which come at 30 to 120 Hz with jitter, into a steady stream of poses. It plays the straight path
/// between targets one interval later, never faster than a limit. Threads: one. Real-time: yes.
class PoseFollower {
 public:
  static constexpr std::int64_t kPatienceNs = 250'000'000;  ///< longest time without a target
  static constexpr std::int64_t kFirstNs = 2'000'000'000;   ///< longest time until the first one
  static constexpr std::int64_t kMaxDelayNs = 50'000'000;   ///< largest delay of the playing
  static constexpr double kLift = 0.02;                     ///< distance off the organ after a release, m
  static constexpr double kLiftSpeed = 0.15;                ///< m/s, less where the limit is lower

  enum class State {
    kWaiting,  ///< no target yet
    kFollowing,
    kLifting,  ///< released: moves off the organ
    kOver      ///< lifted off, or without targets for kPatienceNs
  };

  /// @param[in] now_ns       of the clock that step() is called with
  /// @param[in] speed_limit  m/s, above 0
  PoseFollower(std::int64_t now_ns, double speed_limit) noexcept
      : speed_limit_(speed_limit), last_target_ns_(now_ns) {}

  /// The wanted position of the tip's centre, world W, m. No effect after a release.
  void target(const Point& p_WT, std::int64_t now_ns) noexcept;

  /// The page takes the tool back before kOver: it continues from its position at the next target.
  void regrab(std::int64_t now_ns) noexcept;

  /// @param[in] outward  unit direction off the organ at the tool
  void release(const Point& outward) noexcept;

  /// The current pose; nothing before the first target and in kOver.
  [[nodiscard]] std::optional<Point> step(std::int64_t now_ns) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  /// The newest pose given by step(). Valid after the first one.
  [[nodiscard]] const Point& position() const noexcept { return position_; }
  /// Delay from a target's arrival to its playing, s.
  [[nodiscard]] double delay() const noexcept { return delay_s_; }

 private:
  struct Timed {
    double t;  // s since the first target
    Point p;
  };
  static constexpr std::size_t kKept = 16;

  [[nodiscard]] Point wanted(double t) const noexcept;
  void play(double now_s, double dt) noexcept;
  void moveTowards(const Point& goal, double longest) noexcept;
  void learnInterval(double interval) noexcept;

  double speed_limit_;
  std::int64_t last_target_ns_;
  std::int64_t origin_ns_{0};
  std::int64_t last_step_ns_{0};
  State state_{State::kWaiting};
  std::array<Timed, kKept> targets_{};
  std::size_t count_{0};
  double longest_s_{1.0 / 60.0};  // recently, between targets
  double delay_s_{1.0 / 60.0};
  double played_s_{0.0};
  bool placed_{false};  // position_ holds a pose that step() gave
  Point position_{};
  Point lift_to_{};
};

}  // namespace palpate::device
