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
    1U << 4;  ///< d is beyond what the model answers: that of the nearest d, f or level is given
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
    1U << 10;  ///< sender's stamps went backwards (set by the server)

/// What a tool does to the organ; ToolResult::state and ToolForce::state.
enum class ContactState : std::uint32_t { kFree = 0, kStick = 1, kSlide = 2 };

}  // namespace palpate
