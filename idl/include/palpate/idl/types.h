// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <palpate.h>  // generated from palpate.idl, where every field, frame, sign and unit is documented

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace palpate::dds {

using ToolPose = palpate_ToolPose;
using ToolForce = palpate_ToolForce;
using SurfaceDisplacement = palpate_SurfaceDisplacement;
using SurfaceMesh = palpate_SurfaceMesh;
using Percentiles = palpate_Percentiles;
using ServerStatus = palpate_ServerStatus;
using ParameterRequest = palpate_ParameterRequest;
using ServerParameters = palpate_ServerParameters;

/// Bits of ToolForce::flags, as palpate.idl documents them.
namespace flag {
inline constexpr std::uint32_t kInContact = palpate_FLAG_IN_CONTACT;
inline constexpr std::uint32_t kNonFinitePose = palpate_FLAG_NON_FINITE_POSE;
inline constexpr std::uint32_t kNonUnitQuaternion = palpate_FLAG_NON_UNIT_QUATERNION;
inline constexpr std::uint32_t kStalePose = palpate_FLAG_STALE_POSE;
inline constexpr std::uint32_t kBeyondDomain = palpate_FLAG_BEYOND_DOMAIN;
inline constexpr std::uint32_t kForceLimited = palpate_FLAG_FORCE_LIMITED;
inline constexpr std::uint32_t kNotAccessible = palpate_FLAG_NOT_ACCESSIBLE;
inline constexpr std::uint32_t kRamping = palpate_FLAG_RAMPING;
inline constexpr std::uint32_t kShuttingDown = palpate_FLAG_SHUTTING_DOWN;
inline constexpr std::uint32_t kNonFiniteForce = palpate_FLAG_NON_FINITE_FORCE;
inline constexpr std::uint32_t kPoseOutOfOrder = palpate_FLAG_POSE_OUT_OF_ORDER;
inline constexpr std::uint32_t kForceRateLimited = palpate_FLAG_FORCE_RATE_LIMITED;
inline constexpr std::uint32_t kPoseJump = palpate_FLAG_POSE_JUMP;
inline constexpr std::uint32_t kTwoPublishers = palpate_FLAG_TWO_PUBLISHERS;
inline constexpr std::uint32_t kUnknownTool = palpate_FLAG_UNKNOWN_TOOL;
inline constexpr std::uint32_t kToolNotConfigured = palpate_FLAG_TOOL_NOT_CONFIGURED;
inline constexpr std::uint32_t kTickOverrun = palpate_FLAG_TICK_OVERRUN;
}  // namespace flag

/// Bits of ParameterRequest::fields.
namespace parameter {
inline constexpr std::uint32_t kYoungsModulus = palpate_PARAMETER_YOUNGS_MODULUS;
inline constexpr std::uint32_t kFriction = palpate_PARAMETER_FRICTION;
inline constexpr std::uint32_t kCouplingStiffness = palpate_PARAMETER_COUPLING_STIFFNESS;
inline constexpr std::uint32_t kCouplingDamping = palpate_PARAMETER_COUPLING_DAMPING;
inline constexpr std::uint32_t kForceLimit = palpate_PARAMETER_FORCE_LIMIT;
inline constexpr std::uint32_t kForceRateLimit = palpate_PARAMETER_FORCE_RATE_LIMIT;
inline constexpr std::uint32_t kAll = 63;
}  // namespace parameter

/// Values of ToolForce::state.
namespace tool_state {
inline constexpr std::uint32_t kFree = palpate_STATE_FREE;
inline constexpr std::uint32_t kStick = palpate_STATE_STICK;
inline constexpr std::uint32_t kSlide = palpate_STATE_SLIDE;
}  // namespace tool_state

/// Values of ServerStatus::state.
namespace server_state {
inline constexpr std::uint32_t kStarting = palpate_SERVER_STARTING;
inline constexpr std::uint32_t kRunning = palpate_SERVER_RUNNING;
inline constexpr std::uint32_t kStopping = palpate_SERVER_STOPPING;
}  // namespace server_state

/// ServerStatus::phase_lock.
namespace phase {
inline constexpr std::uint32_t kOff = palpate_PHASE_OFF;
inline constexpr std::uint32_t kFree = palpate_PHASE_FREE;
inline constexpr std::uint32_t kSeeking = palpate_PHASE_SEEKING;
inline constexpr std::uint32_t kLocked = palpate_PHASE_LOCKED;
inline constexpr std::uint32_t kWaiting = palpate_PHASE_WAITING;
}  // namespace phase

/// Writes a text into a bounded IDL string, cut to fit, always terminated.
/// Real-time: yes.
template <std::size_t N>
void assignText(char (&field)[N], std::string_view text) noexcept {
  const std::size_t length = std::min(text.size(), N - 1);
  std::memcpy(field, text.data(), length);
  field[length] = '\0';
}

}  // namespace palpate::dds
