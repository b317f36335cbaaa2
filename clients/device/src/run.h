// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "palpate/client/tool_client.h"
#include "palpate/device/held_device.h"
#include "palpate/device/verdict.h"

namespace palpate::device {

/// What happened while a held device ran against a server.
struct Recording {
  Trace trace;  ///< one entry for each step of 1 ms; its force is that which the server answered
  std::vector<double> penetration;  ///< as the server saw it, one for each entry, m
  std::vector<double> work;         ///< done on the organ until then, J
  std::uint32_t flags{0};           ///< FLAG_* of all answers, or-ed
  std::uint64_t waited{0};          ///< periods in which the device stood still because an answer was missing
  bool server_left{false};          ///< the server said that it shuts down
  bool interrupted{false};
};

/// Runs a device for the length of its path, in periods of 1 ms: at the begin of each it sends its pose, and goes on by
/// 1 ms with the newest force that it has by then, usually that of the pose before (closedLoop() with a delay of 1). The
/// device's time is its steps: where the answer to the pose before is missing, or the server lets the force go
/// because poses came late, the device stands still and sends on, so that a stall of a process is neither felt nor mistaken
/// for an instability.
/// @throw client::ClientError when no server takes poses, or none answers for a second
[[nodiscard]] Recording run(const dds::Participant& participant, std::uint32_t tool_id, HeldDevice& device);

}  // namespace palpate::device
