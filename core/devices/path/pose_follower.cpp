// SPDX-License-Identifier: Apache-2.0
#include "core/devices/path/pose_follower.h"

#include <algorithm>
#include <cmath>

namespace palpate::device {

// The longest recent interval, and a little more: rises at once, falls slowly.
void PoseFollower::learnInterval(double interval) noexcept {
  constexpr double kForget = 0.002;
  constexpr double kPause = 0.2;  // s; a longer interval is a pause, not the rhythm
  if (interval > kPause) return;
  longest_s_ = std::max(interval, (1.0 - kForget) * longest_s_);
  delay_s_ = std::clamp(1.1 * longest_s_, 0.004, static_cast<double>(kMaxDelayNs) * 1e-9);
}

void PoseFollower::target(const Point& p_WT, std::int64_t now_ns) noexcept {
  if (state_ == State::kLifting || state_ == State::kOver) return;
  if (state_ == State::kWaiting) {
    state_ = State::kFollowing;
    origin_ns_ = now_ns;
    last_step_ns_ = now_ns;
    if (!placed_) position_ = p_WT;
    placed_ = true;
  } else {
    learnInterval(static_cast<double>(now_ns - last_target_ns_) * 1e-9);
  }
  last_target_ns_ = now_ns;
  targets_[count_ % kKept] = {static_cast<double>(now_ns - origin_ns_) * 1e-9, p_WT};
  ++count_;
}

void PoseFollower::regrab(std::int64_t now_ns) noexcept {
  if (state_ != State::kLifting) return;
  state_ = State::kWaiting;
  last_target_ns_ = now_ns;
  count_ = 0;
  played_s_ = 0.0;
}

void PoseFollower::release(const Point& outward) noexcept {
  if (state_ == State::kOver || state_ == State::kLifting) return;
  if (state_ == State::kWaiting) {
    state_ = State::kOver;
    return;
  }
  state_ = State::kLifting;
  lift_to_ = position_ + kLift * outward;
}

Point PoseFollower::wanted(double t) const noexcept {
  const std::size_t newest = count_ - 1;
  const std::size_t oldest = count_ > kKept ? count_ - kKept : 0;
  for (std::size_t i = newest; i > oldest; --i) {
    const Timed& to = targets_[i % kKept];
    const Timed& from = targets_[(i - 1) % kKept];
    if (t >= to.t) return to.p;
    if (t < from.t || to.t <= from.t) continue;
    return from.p + ((t - from.t) / (to.t - from.t)) * (to.p - from.p);
  }
  return targets_[oldest % kKept].p;
}

void PoseFollower::moveTowards(const Point& goal, double longest) noexcept {
  const Point way = goal - position_;
  const double size = length(way);
  position_ = size > longest ? position_ + (longest / size) * way : goal;
}

// The playing clock runs up to a fifth faster or slower until it is `delay_s_` behind. It waits at the newest target, so that
// the tool does not jump when the next target comes late.
void PoseFollower::play(double now_s, double dt) noexcept {
  constexpr double kCatchUp = 0.1;  // s
  double behind = now_s - delay_s_ - played_s_;
  if (behind > kCatchUp) {  // after a stall; the speed limit still holds
    played_s_ += behind;
    behind = 0.0;
  }
  played_s_ += dt * (1.0 + std::clamp(behind / kCatchUp, -0.2, 0.2));
  played_s_ = std::min(played_s_, targets_[(count_ - 1) % kKept].t);
  moveTowards(wanted(played_s_), speed_limit_ * dt);
}

std::optional<Point> PoseFollower::step(std::int64_t now_ns) noexcept {
  if (state_ == State::kOver) return std::nullopt;
  const std::int64_t patience = state_ == State::kWaiting ? kFirstNs : kPatienceNs;
  if (state_ != State::kLifting && now_ns - last_target_ns_ > patience) state_ = State::kOver;
  if (state_ == State::kOver || state_ == State::kWaiting) return std::nullopt;
  constexpr double kLongestStep = 0.005;  // s: does not make up for a stall in one stride
  const double dt = std::clamp(static_cast<double>(now_ns - last_step_ns_) * 1e-9, 0.0, kLongestStep);
  last_step_ns_ = now_ns;
  if (state_ == State::kLifting) {
    moveTowards(lift_to_, std::min(kLiftSpeed, speed_limit_) * dt);
    if (length(lift_to_ - position_) < 1e-9) state_ = State::kOver;
  } else {
    play(static_cast<double>(now_ns - origin_ns_) * 1e-9, dt);
  }
  return position_;
}

}  // namespace palpate::device
