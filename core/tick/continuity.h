// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/types.h"
#include "core/contact/contact.h"
#include "core/contact/contact_solver.h"
#include "core/tick/step_config.h"
#include "core/tick/step_io.h"

namespace palpate {

/// Why the force of a tool does not follow from its last one: all causes that there are. Whatever the cause, force and field
/// go over from what they were within ramp_time (ForceLimiter, Stepper::deform); what else is done stands beside it. Bits,
/// since several may come together.                                                    docs/decisions/jumps.md
enum Discontinuity : std::uint32_t {
  /// No good pose was known. The force begins from zero.
  kFirstPose = 1,
  /// No good pose came for stale_timeout. The force was fading; when it is zero the contact is given up.
  kPoseCameBack = 2,
  /// The pose is farther from the last one than speed_limit allows. kPoseJump; the contact is forgotten (TipWay::kNone).
  kPoseLeapt = 4,
  /// More than ten periods and 10 ms between two ticks, and the tool in contact: the hand went on meanwhile.
  kLoopStoodStill = 8,
  /// A live parameter changed with no numbers to go through (LiveBlend::jumped()), and the tool in contact.
  kParameterSwitched = 16,
  /// The contact came, went or snapped: ContactJump says which, also of a tool whose way was not seen.
  kContactJumped = 32,
  /// Another tool had one of the causes above in the last tick, or its contact was given up: this one, in contact, feels it.
  kOthersJumped = 64,
};

/// The time of one tick.
struct TickTime {
  explicit TickTime(const StepInput& input) noexcept PALPATE_NONBLOCKING;

  double since_last;  ///< s, 0 to 0.1
  double period;      ///< s; the caller's, or 1 ms
  double ramp;        ///< s that ramps advance: without the time that the loop stood still
  bool stood_still;   ///< kLoopStoodStill
};

/// What a tool's input is worth in a tick.
struct PoseJudgement {
  std::uint32_t flags{0};         ///< kNonFinitePose, kNonUnitQuaternion of the pose itself
  bool usable{false};             ///< there is one, without these flags, not older than stale_timeout
  TipWay way{TipWay::kStraight};  ///< from the last usable pose
};

/// Whether a tool's force follows from its last one: judges its poses, and keeps each discontinuity until a force is given.
class Continuity {
 public:
  /// A good pose was seen.
  [[nodiscard]] bool known() const noexcept PALPATE_NONBLOCKING { return known_; }
  /// Since the last good pose, s.
  [[nodiscard]] double age() const noexcept PALPATE_NONBLOCKING { return age_; }

  /// First in a tick. Real-time: yes.
  [[nodiscard]] PoseJudgement judge(const ToolInput& tool, const TickTime& time,
                                    const StepConfig& config) noexcept PALPATE_NONBLOCKING;
  /// Keeps a cause for the next force. Real-time: yes.
  void disturb(Discontinuity cause) noexcept PALPATE_NONBLOCKING { waiting_ |= cause; }
  /// When the contact followed the pose. @param others_jumped  in the last tick
  /// @return the discontinuities of its force, bits. Real-time: yes.
  [[nodiscard]] std::uint32_t take(const Contact& contact, bool others_jumped,
                                   const StepConfig& config) noexcept PALPATE_NONBLOCKING;
  /// Last in a tick: the pose's age. @param good  it was usable, and the model had a finite answer. Real-time: yes.
  void end(const ToolInput& tool, bool good, const TickTime& time,
           const StepConfig& config) noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] TipWay wayTo(const Vec3& here, double between, double period,
                             const StepConfig& config) const noexcept PALPATE_NONBLOCKING;

  bool known_{false};
  double age_{0.0};               // s
  Vec3 position_ = Vec3::Zero();  // of the last usable pose, m
  std::uint32_t waiting_{0};      // discontinuities since the last force
};

}  // namespace palpate
