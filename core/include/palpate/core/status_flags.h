// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate {

// Bits of ToolResult::flags, and of ToolForce::flags on the wire: plain constants, so that the IDL can mirror
// them. A bit's place never changes; new ones are added at the end.

inline constexpr std::uint32_t kInContact = 1U << 0;  ///< the tool sticks to or slides on the organ
inline constexpr std::uint32_t kNonFinitePose =
    1U << 1;  ///< NaN, infinity or beyond 1 km in the pose; answered like a stale pose
inline constexpr std::uint32_t kNonUnitQuaternion =
    1U << 2;  ///< orientation is no rotation; answered like a stale pose
inline constexpr std::uint32_t kStalePose =
    1U << 3;  ///< no good pose for stale_timeout; the force ramps to zero
inline constexpr std::uint32_t kBeyondDomain =
    1U << 4;  ///< d is beyond what the model answers: the force goes on, or is that of the nearest f or level
/// |f| above the force limit; direction kept, size cut
inline constexpr std::uint32_t kForceLimited = 1U << 5;
inline constexpr std::uint32_t kNotAccessible =
    1U << 6;  ///< the tip touches the organ where no answer was computed
inline constexpr std::uint32_t kRamping =
    1U << 7;  ///< the force is on its way to or from the model's, or fading
inline constexpr std::uint32_t kShuttingDown =
    1U << 8;  ///< the server stops; the force goes to zero and stays there
inline constexpr std::uint32_t kNonFiniteForce =
    1U
    << 9;  ///< the model's answer is no number: a force is answered like a stale pose, a field is shown as zero
inline constexpr std::uint32_t kPoseOutOfOrder =
    1U << 10;  ///< a pose's seq went back or repeated, or its stamp went back (set by the server)
/// the force would change faster than force_rate_limit; it follows at that rate
inline constexpr std::uint32_t kForceRateLimited = 1U << 11;
/// the pose moved faster than speed_limit: the contact is given up, and found anew like that of a new tool
inline constexpr std::uint32_t kPoseJump = 1U << 12;
/// poses of this tool come from a second publisher too; those are not used (set by the server)
inline constexpr std::uint32_t kTwoPublishers = 1U << 13;
inline constexpr std::uint32_t kUnknownTool = 1U << 14;  ///< tool_id above 3: no force (set by the server)
/// tool_id not below StepConfig::tools: no force (set by the server)
inline constexpr std::uint32_t kToolNotConfigured = 1U << 15;
inline constexpr std::uint32_t kTickOverrun =
    1U << 16;  ///< ticks were missed before this one (set by the server)

/// What a tool does to the organ; ToolResult::state and ToolForce::state.
enum class ContactState : std::uint32_t { kFree = 0, kStick = 1, kSlide = 2 };

}  // namespace palpate
