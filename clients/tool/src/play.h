// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/devices/path/path.h"
#include "palpate/client/gap_counter.h"
#include "palpate/client/server_hold.h"
#include "palpate/idl/participant.h"
#include "palpate/idl/types.h"

namespace palpate::tool {

/// The first answer to one pose.
struct Sample {
  double t_s;          ///< when the pose was sent, s since the start
  device::Point pose;  ///< p_WT, m
  dds::ToolForce force;
};

/// Record of a played path.
struct Recording {
  std::vector<Sample> samples;  ///< in the order of the poses
  client::GapCounter answers;
  std::uint64_t sent{0};
  client::LeftOut left_out;         ///< forces of other servers
  std::string left_out_text;        ///< whose; empty: none
  std::uint64_t model_changes{0};   ///< how often the server took another model
  std::uint64_t missed_periods{0};  ///< periods that this process missed
  bool server_left{false};          ///< the server said that it shuts down
  /// Poses without a recorded answer: superseded, or their answer was lost.
  [[nodiscard]] std::uint64_t unanswered() const noexcept { return sent - samples.size(); }
  /// Poses that the server replaced by newer ones before a tick used them, by its own count.
  [[nodiscard]] std::uint64_t superseded() const noexcept {
    return samples.empty() ? 0 : samples.back().force.superseded - samples.front().force.superseded;
  }
};

/// Sends poses along the path at 1 kHz to one server and records the answers. Ends early on a stop signal or when the
/// server leaves.
/// @throw client::ClientError  no server takes poses, or none answers
[[nodiscard]] Recording play(const dds::Participant& participant, std::uint32_t tool_id,
                             const device::Path& path, const client::ServerRun& server);

}  // namespace palpate::tool
