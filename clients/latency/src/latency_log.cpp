// SPDX-License-Identifier: Apache-2.0
#include "latency_log.h"

#include <algorithm>

namespace palpate::latency {
namespace {

constexpr std::int64_t kLongest = 3'600'000'000'000;  // ns; keeps differences within 64 bits

/// A stamp that comes from outside, within an hour of when it came back.
std::int64_t stampOf(std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  return std::clamp(stamp_ns, received_ns - kLongest, received_ns + kLongest);
}

/// From the pose's arrival to the deadline of its tick, as the server states it, clamped to what is possible.
std::int64_t waitOf(const dds::ToolForce& force) noexcept {
  const auto sane = [&](std::int64_t ns) { return std::clamp<std::int64_t>(ns, -kLongest, kLongest); };
  return std::max<std::int64_t>(0, sane(force.pose_wait_ns) - sane(force.wakeup_ns));
}

}  // namespace

/// least_ns and what poses one, two, ... periods older make of it.
void LatencyLog::addOnGrid(std::int64_t least_ns, std::int64_t poses) noexcept {
  constexpr std::int64_t kMost = 100'000;  // bounds the receive thread's work; 25 s at 4 kHz
  for (std::int64_t j = 0; j < std::min(poses, kMost); ++j) pose_to_force_.add(least_ns + j * period_ns_);
}

void LatencyLog::finish(std::int64_t end_ns) noexcept {
  const std::int64_t since_ns = end_ns - answered_stamp_ns_;
  const std::int64_t poses = (since_ns - 2 * period_ns_ - 1) / period_ns_;
  if (answered_stamp_ns_ != 0) addOnGrid(since_ns - poses * period_ns_, poses);
}

void LatencyLog::add(const dds::ToolForce& force, std::int64_t received_ns) noexcept {
  const bool known = force.pose_seq <= newest_pose_;
  if (!known) newest_pose_ = force.pose_seq;
  newest_answer_ns_ = received_ns;
  if (!recording_.load(std::memory_order_relaxed)) return;
  const std::uint64_t restarts_before = answers_.restarts();
  answers_.add(force.session, force.seq);
  last_ = {force.overruns, force.superseded};
  if (answers_.received() == 1 || answers_.restarts() != restarts_before) first_ = last_;
  wakeup_.add(force.wakeup_ns);
  tick_.add(force.tick_ns);
  if (force.pose_stamp_ns == 0) return;
  const std::int64_t stamp_ns = stampOf(force.pose_stamp_ns, received_ns);
  const std::int64_t age_ns = received_ns - stamp_ns;
  if (age_ns > 2 * period_ns_) ++late_;
  if (known) return;  // only the first answer to a pose gives a round trip
  const std::int64_t wait_ns = waitOf(force);
  // A pose a little late is not two.
  const std::int64_t span_ns = answered_stamp_ns_ == 0 ? 0 : stamp_ns - answered_stamp_ns_;
  answered_stamp_ns_ = stamp_ns;
  addOnGrid(age_ns, std::max<std::int64_t>(1, (span_ns + period_ns_ / 4) / period_ns_));
  answered_.add(age_ns);
  wait_.add(wait_ns);
  less_wait_.add(age_ns - wait_ns);
}

void LatencyLog::addField(const dds::SurfaceDisplacement& field, std::uint32_t tool,
                          std::int64_t received_ns) noexcept {
  const std::uint64_t pose = field.pose_seq[tool];
  if (pose <= newest_field_pose_) return;  // of several fields of one pose the first counts
  newest_field_pose_ = pose;
  if (field.pose_stamp_ns[tool] == 0 || !recording_.load(std::memory_order_relaxed)) return;
  pose_to_field_.add(received_ns - stampOf(field.pose_stamp_ns[tool], received_ns));
}

}  // namespace palpate::latency
