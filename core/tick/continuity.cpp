// SPDX-License-Identifier: Apache-2.0
#include "core/tick/continuity.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {

namespace {

/// Flags of the pose itself; 0 when it is sound.
std::uint32_t flagsOf(const ToolInput& tool, double quaternion_tolerance) noexcept PALPATE_NONBLOCKING {
  constexpr double kFarthest = 1000.0;  // m; larger than any scene, and squares stay finite
  for (const double x : tool.position)
    if (!(std::abs(x) <= kFarthest)) return kNonFinitePose;
  double square = 0.0;
  for (const double q : tool.orientation) {
    if (!std::isfinite(q)) return kNonFinitePose;
    square += q * q;
  }
  return std::abs(std::sqrt(square) - 1.0) <= quaternion_tolerance ? 0 : kNonUnitQuaternion;
}

double ageOf(const ToolInput& tool) noexcept PALPATE_NONBLOCKING {
  return 1e-9 * double(tool.age_ns);
}

}  // namespace

TickTime::TickTime(const StepInput& input) noexcept PALPATE_NONBLOCKING
    : since_last(std::clamp(1e-9 * double(input.dt_ns), 0.0, 0.1)),
      period(input.period_ns > 0 ? std::min(1e-9 * double(input.period_ns), 0.1) : 1e-3),
      ramp(std::min(since_last, 2.0 * period)) {
  constexpr double kStall = 0.01;  // s; in a faster loop, a hand does not notice ten periods
  stood_still = 1e-9 * double(input.dt_ns) > std::max(10.0 * period, kStall);
}

PoseJudgement Continuity::judge(const ToolInput& tool, const TickTime& time,
                                const StepConfig& config) noexcept PALPATE_NONBLOCKING {
  PoseJudgement out;
  if (tool.present == 0) return out;
  out.flags = flagsOf(tool, config.quaternion_tolerance);
  out.usable = out.flags == 0 && ageOf(tool) <= config.stale_timeout;
  if (!out.usable) return out;
  const Vec3 here(tool.position[0], tool.position[1], tool.position[2]);
  if (known_) out.way = wayTo(here, age_ + time.since_last - ageOf(tool), time.period, config);
  position_ = here;
  return out;
}

/// What is known of the way from the last usable pose. Unseen: so long no pose came, in a loop that would have taken one in
/// every period. @param between  the arrivals of the last good pose and this one, s; they come unevenly, so with a margin
TipWay Continuity::wayTo(const Vec3& here, double between, double period,
                         const StepConfig& config) const noexcept PALPATE_NONBLOCKING {
  constexpr double kUneven = 2e-3;  // s
  const double longest = std::max(0.0, between) + kUneven;
  if ((here - position_).norm() > config.speed_limit * longest) return TipWay::kNone;
  const bool unseen = longest - period > config.stale_timeout + 2.0 * kUneven;
  return unseen ? TipWay::kUnseen : TipWay::kStraight;
}

std::uint32_t Continuity::take(const Contact& contact, bool others_jumped,
                               const StepConfig& config) noexcept PALPATE_NONBLOCKING {
  std::uint32_t causes = std::exchange(waiting_, 0);
  if (!known_) causes |= kFirstPose;
  if (age_ > config.stale_timeout) causes |= kPoseCameBack;
  if (contact.jumped()) causes |= kContactJumped;
  if (others_jumped && !contact.isFree()) causes |= kOthersJumped;
  return causes;
}

void Continuity::end(const ToolInput& tool, bool good, const TickTime& time,
                     const StepConfig& config) noexcept PALPATE_NONBLOCKING {
  known_ = known_ || good;
  age_ = good ? 0.0 : age_ + time.since_last;
  if (tool.present != 0) age_ = std::max(age_, ageOf(tool));
  if (!known_) age_ = std::max(age_, config.zero_after);
}

}  // namespace palpate
