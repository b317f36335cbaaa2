// SPDX-License-Identifier: Apache-2.0
#include "core/tick/force_limiter.h"

#include <algorithm>

namespace palpate {

namespace {

constexpr double kRounding = 1.0 + 1e-12;  // what was cut to the limit is not longer than it

/// f cut to the length `limit`, K with it: d(limit f/|f|)/df = limit/|f| (I - f f^T / f.f). @return true when
/// cut
bool cut(double limit, Vec3& f, Mat3& K) noexcept PALPATE_NONBLOCKING {
  const double length = f.norm();
  if (!(length > limit)) return false;
  const Vec3 direction = f / length;
  K = ((limit / length) * (Mat3::Identity() - direction * direction.transpose()) * K).eval();
  f = limit * direction;
  return true;
}

/// `to`, or as far towards it as `most` N lead; K of what is cut is zero. @return true when cut
bool follow(const Vec3& from, double most, Vec3& to, Mat3& K) noexcept PALPATE_NONBLOCKING {
  const double way = (to - from).norm();
  if (!(way > most)) return false;
  to = from + (most / way) * (to - from);
  K.setZero();
  return true;
}

/// How much of a force the rate limit lets go in a tick, as a share of it.
double shareOf(const LimiterInput& in, const Vec3& force) noexcept PALPATE_NONBLOCKING {
  const double length = force.norm();
  return length > 0.0 ? in.force_rate_limit * in.dt / length : 1.0;
}

}  // namespace

double ForceLimiter::freshness(double age_at_end) const noexcept PALPATE_NONBLOCKING {
  return std::clamp((config_.zero_after - age_at_end) / (config_.zero_after - config_.stale_timeout), 0.0,
                    1.0);
}

LimitedForce ForceLimiter::limit(const LimiterInput& in,
                                 Rendering& memory) const noexcept PALPATE_NONBLOCKING {
  LimitedForce out;
  Mat3 K = Mat3::Zero();
  if (!in.held) {
    Vec3 target = in.force;
    K = in.stiffness;
    if (cut(in.force_limit, target, K)) out.flags |= kForceLimited;
    memory.target = target;
  }
  if (in.jumped) {
    memory.from = memory.rendered;
    memory.mixed = memory.rendered;
    memory.blend = 1.0;
  }
  const double step = config_.ramp_time > 0.0 ? in.dt / config_.ramp_time : 1.0;
  memory.blend = std::max(0.0, memory.blend - step);
  if (in.shutting_down) memory.fade = std::max(0.0, memory.fade - step);
  if (in.hands_over) memory.fade = std::max(0.0, memory.fade - std::min(step, shareOf(in, memory.mixed)));
  const double gain = memory.fade * freshness(in.age + in.period);
  memory.gain = in.shutting_down || in.hands_over ? std::min(memory.gain, gain) : gain;
  Vec3 mixed = (1.0 - memory.blend) * memory.target + memory.blend * memory.from;
  if (in.hands_over) mixed = memory.mixed;
  if (follow(memory.mixed, in.force_rate_limit * in.dt, mixed, K)) out.flags |= kForceRateLimited;
  if (mixed.norm() > kRounding * in.force_limit && cut(in.force_limit, mixed, K)) out.flags |= kForceLimited;
  memory.mixed = mixed;
  out.force = memory.gain * mixed;
  out.stiffness = memory.gain * (1.0 - memory.blend) * K;
  memory.rendered = out.force;
  if (in.age > config_.stale_timeout) out.flags |= kStalePose;
  if (out.force != memory.target) out.flags |= kRamping;
  if (in.shutting_down) out.flags |= kShuttingDown;
  if (in.hands_over) out.flags |= kModelChanging;
  return out;
}

}  // namespace palpate
