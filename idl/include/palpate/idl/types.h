// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <palpate.h>  // generated from palpate.idl, where every field, frame, sign and unit is documented

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

// Made from the lists in palpate.idl: dds::flag::kStalePose, dds::parameter::kFriction and the rest.
#include "palpate/idl/status_flag_list.h"
#include "palpate/live_parameter_list.h"

namespace palpate::dds {

using ToolPose = palpate_ToolPose;
using ToolForce = palpate_ToolForce;
using SurfaceDisplacement = palpate_SurfaceDisplacement;
using SurfaceMesh = palpate_SurfaceMesh;
using Region = palpate_Region;
using Percentiles = palpate_Percentiles;
using RecentTimes = palpate_RecentTimes;
using LateTicks = palpate_LateTicks;
using LiveValues = palpate_LiveValues;
using ToolParameters = palpate_ToolParameters;
using ToolAnnouncement = palpate_ToolAnnouncement;

/// ParameterRequest::tool_id: every tool.
inline constexpr std::uint32_t kAllTools = palpate_TOOL_ALL;

using ServerStatus = palpate_ServerStatus;
using ParameterRequest = palpate_ParameterRequest;
using ServerParameters = palpate_ServerParameters;

/// ToolPose::server_id: whichever server serves the domain.
inline constexpr std::uint32_t kServerAny = palpate_SERVER_ANY;

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

/// Lets an IDL sequence borrow the caller's memory for a write, which only reads.
/// Real-time: yes.
template <class Sequence, class T>
void lend(Sequence& sequence, const T* data, std::size_t size) noexcept {
  sequence._maximum = static_cast<std::uint32_t>(size);
  sequence._length = static_cast<std::uint32_t>(size);
  sequence._buffer = const_cast<T*>(data);
  sequence._release = false;
}

}  // namespace palpate::dds
