// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/devices/sim/contact_energy.h"
#include "core/devices/sim/delays.h"
#include "core/devices/sim/held_device.h"
#include "palpate/client/tool_client.h"

namespace palpate::device {

/// Record of a held device that ran against a server.
struct Recording {
  Trace trace;                      ///< one entry per step of 1 ms; its force is the server's answer
  std::vector<double> penetration;  ///< the server's figure, one per entry, m
  std::vector<double> work;         ///< done on the organ until then, J
  std::uint32_t flags{0};           ///< FLAG_* of all answers, or-ed
  client::LeftOut left_out;         ///< forces of other servers
  std::uint64_t model_changes{0};   ///< how often the server took another model
  std::uint64_t waited{0};  ///< periods in which the device stood still: an answer, or the process, was late
  bool server_left{false};  ///< the server said that it shuts down
  bool interrupted{false};
};

/// Periods that are a stall: after a longer pause of its ticks the server blends the force of a contact (Discontinuity).
inline constexpr std::uint64_t kStall = 10;

/// Runs a device along its path, in periods of 1 ms. In each the device sends its pose and advances by 1 ms under
/// the answer to the pose of the step before (closedLoop() with a delay of 1): of exactly that one, or, where the
/// server never answered it because a later pose superseded it, the newest answer to one before. The device's time
/// is its steps. While that answer may still come, or the server blends the force because poses or ticks stopped,
/// the device stands still. What the server does with its own clock meanwhile is felt; so a wait of kStall periods,
/// a pause of the ticks that is longer, and a force that the server blended are noted in Trace::stalled, and not
/// judged.
/// @param[in] delays  measured ones, from where they are worst for as long as the run is: in each step the answer
///   to the pose acts that acted in that period of the measurement, and where no pose went out then, none does.
///   Nothing: as above
/// @throw client::ClientError  no server takes poses, none answers for a second, or one sends what is not finite
[[nodiscard]] Recording run(const dds::Participant& participant, std::uint32_t tool_id, HeldDevice& device,
                            const client::ServerRun& server, const Delays* delays = nullptr);

}  // namespace palpate::device
