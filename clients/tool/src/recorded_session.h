// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/devices/path/path.h"

namespace palpate::tool {

inline constexpr std::size_t kTools = 4;

/// A pose that a tick of a recorded session used, and what the first tick that knew it answered.
struct RecordedPose {
  std::int64_t t_ns{0};                           ///< when it is to be sent, since the session's first pose
  std::uint32_t tool{0};                          ///< tool id in the session
  device::Point position;                         ///< p_WT, m; as it came, also where it is not finite
  std::array<double, 4> orientation{0, 0, 0, 1};  ///< q_WT, x y z w
  std::uint32_t buttons{0};
  device::Point force;     ///< on the tool, N
  device::Point anchor;    ///< of the contact, m
  std::uint32_t flags{0};  ///< FLAG_*
  std::uint32_t state{0};  ///< STATE_*
  bool letting_go{false};  ///< the server faded the force, because poses had stopped
  bool late{false};        ///< its tick came more than half a period late
};

/// What of a recording can be sent again.
struct RecordedSession {
  std::string model_id;                     ///< of the organ that was touched
  std::string engine;                       ///< that answered
  std::array<double, kTools> tip_radius{};  ///< m, at the session's start
  std::array<bool, kTools> has{};           ///< tools with poses
  std::array<bool, kTools>
      by_stamp{};                   ///< timing from the sender's stamps; else from the arrival at the server
  std::uint64_t changes{0};         ///< ticks that took other live parameters: these are not sent
  std::uint64_t missing{0};         ///< ticks that the session ran and the file does not hold
  bool truncated{false};            ///< the file has no end
  std::vector<RecordedPose> poses;  ///< in the order of t_ns, at least one

  [[nodiscard]] double seconds() const noexcept { return 1e-9 * static_cast<double>(poses.back().t_ns); }
};

/// What is wanted of a recording.
struct Wanted {
  std::optional<std::uint32_t> tool;  ///< only this one's poses, 0 to 3
  std::optional<double> seconds;      ///< only those of the first so many, from the first pose on
  bool partial{false};                ///< also of a recording without an end, or without some ticks
};

/// Reads the poses of a session and when they were sent. Poses that the server replaced before a tick used them are in no
/// recording. A tool's timing is that of its stamps where all are valid, never go back, and keep within 0.1 s of the arrivals;
/// else that of the arrivals. The file is not trusted.
/// @throw record::RecordError  no recording, damaged, truncated or without some ticks (unless partial), times that no session has,
///        no pose of a wanted tool, or poses beyond a day
[[nodiscard]] RecordedSession readSession(const std::filesystem::path& file, const Wanted& wanted);

}  // namespace palpate::tool
