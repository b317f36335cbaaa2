// SPDX-License-Identifier: Apache-2.0
#include "force_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palpate_haptic_flags.h"

namespace palpate::haptic {
namespace {

Point pointOf(const Vec3& v) noexcept {
  return {v[0], v[1], v[2]};
}

template <std::size_t N>
bool isFinite(const std::array<double, N>& values) noexcept {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

Point times(const std::array<double, 9>& S, const Point& v) noexcept {
  Point result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = S[3 * i] * v[0] + S[3 * i + 1] * v[1] + S[3 * i + 2] * v[2];
  return result;
}

Point shortenedTo(double longest, const Point& v) noexcept {
  const double size = length(v);
  return size <= longest ? v : (longest / size) * v;
}

// v without its part along `direction` when that part is negative (sign = 1) or positive (sign = -1).
Point without(const Point& v, const Point& direction, double sign) noexcept {
  const double square = dot(direction, direction);
  const double part = dot(v, direction);
  return square > 0.0 && sign * part < 0.0 ? v - (part / square) * direction : v;
}

}  // namespace

void ForceRenderer::sent(std::uint64_t seq, const Point& position,
                         std::int64_t sent_ns) noexcept PALPATE_NONBLOCKING {
  poses_[seq % kPoses] = {seq, position, sent_ns};
  newest_sent_ = seq;
}

bool ForceRenderer::isTooLate(const Answer& answer) const noexcept PALPATE_NONBLOCKING {
  const SentPose& pose = poses_[answer.pose_seq % kPoses];
  if (pose.seq == answer.pose_seq) return answer.first_arrived_ns - pose.sent_ns > kTooLate;
  return answer.pose_seq < newest_sent_ && newest_sent_ - answer.pose_seq >= kPoses;  // forgotten
}

bool ForceRenderer::answered(const Answer& answer) noexcept PALPATE_NONBLOCKING {
  const bool sane = isFinite(answer.force) && isFinite(answer.stiffness) && isFinite(answer.anchor) &&
                    isFinite(answer.proxy);
  if (!sane || (has_answer_ && answer.pose_seq < answer_.pose_seq)) return false;
  if (isTooLate(answer)) {
    ++too_late_;
    return false;
  }
  if (answer.session != answer_.session) gain_ = 0.0;
  answer_ = answer;
  has_answer_ = true;
  comeNear();
  return true;
}

// Of a free tool the anchor is the nearest point of the surface at rest; of a pose that was not used there is none.
void ForceRenderer::comeNear() noexcept PALPATE_NONBLOCKING {
  constexpr std::uint32_t kNotUsed = PALPATE_HAPTIC_FLAG_TOOL_NOT_CONFIGURED |
                                     PALPATE_HAPTIC_FLAG_UNKNOWN_TOOL | PALPATE_HAPTIC_FLAG_NON_FINITE_POSE;
  if ((answer_.flags & kNotUsed) != 0) return;
  constexpr std::uint32_t kFree = 0;  // Force::state
  if (answer_.state != kFree) nearest_ = 0.0;
  const SentPose& pose = poses_[answer_.pose_seq % kPoses];
  if (pose.seq != answer_.pose_seq) return;
  const double distance = length(pose.position - pointOf(answer_.anchor));
  if (distance < nearest_) nearest_ = distance;
}

void ForceRenderer::watch(std::int64_t now_ns) noexcept PALPATE_NONBLOCKING {
  const double since_read =
      read_ns_ == 0 ? 0.0 : 1e-9 * static_cast<double>(std::max<std::int64_t>(now_ns - read_ns_, 0));
  read_ns_ = now_ns;
  age_ = has_answer_ ? 1e-9 * static_cast<double>(std::max<std::int64_t>(now_ns - answer_.arrived_ns, 0))
                     : std::numeric_limits<double>::infinity();
  const double rendered_for = std::min(since_read, kLongestRead);
  const double fresh = std::clamp(1.0 - (age_ + rendered_for - kStaleAfter) / kRamp, 0.0, 1.0);
  const double attentive = std::clamp(1.0 - (since_read - kStaleAfter) / kRamp, 0.0, 1.0);
  // What comes first after a pause may have waited in the socket for as long as that was.
  if (attentive == 0.0) rises_from_ = newest_sent_ + 1;
  const double rise = answer_.pose_seq >= rises_from_ ? rendered_for / kRamp : 0.0;
  gain_ = std::min(fresh, std::min(gain_, attentive) + rise);
}

Point ForceRenderer::extrapolated(const Point& position) const noexcept PALPATE_NONBLOCKING {
  const Point force = pointOf(answer_.force);
  const SentPose& pose = poses_[answer_.pose_seq % kPoses];
  const Point all_the_way = position - pose.position;
  if (pose.seq != answer_.pose_seq || !isFinite(all_the_way)) return force;
  const Point way = shortenedTo(max_extrapolation_, all_the_way);
  const Point change = without(times(answer_.stiffness, way), way, -1.0);
  const Point result = without(force + change, force, 1.0);
  return isFinite(result) ? result : force;
}

Force ForceRenderer::at(const Point* position, std::int64_t now_ns,
                        double limit) noexcept PALPATE_NONBLOCKING {
  watch(now_ns);
  Force out;
  out.age_s = age_;
  out.gain = gain_;
  if (!has_answer_) return out;
  const Point force = position != nullptr ? extrapolated(*position) : pointOf(answer_.force);
  out.force = gain_ * shortenedTo(limit, force);
  out.anchor = answer_.anchor;
  out.proxy = answer_.proxy;
  out.pose_seq = answer_.pose_seq;
  out.flags = answer_.flags;
  out.state = answer_.state;
  out.server_id = answer_.server_id;
  out.session = answer_.session;
  return out;
}

}  // namespace palpate::haptic
