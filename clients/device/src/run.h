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
  std::uint64_t waited{0};          ///< periods in which the device stood still because an answer was late
  bool server_left{false};          ///< the server said that it shuts down
  bool interrupted{false};
};

/// Periods without an answer that are a stall: the server's default stale timeout.
inline constexpr std::uint64_t kStall = 20;

/// Runs a device along its path, in periods of 1 ms. Each period begins with sending the pose; then the device advances by
/// 1 ms under the newest force, usually the answer to the previous pose (closedLoop() with a delay of 1). The device's time
/// is its steps. While that answer is missing, or the server fades the force because poses came late, the device
/// stands still and keeps sending. So a stall of a process is neither felt nor taken for an instability. A wait of kStall
/// periods, or for a force that the server faded, is noted in Trace::stalled: the server's contact may be another one after it.
/// @param[in] delays  measured ones, from where they are worst for as long as the run is, which the answers get on top of being computed: in each step the answer acts that acted in
///                    that period of the measurement, and where no pose went out then, the one before goes out again. Nothing:
///                    the answer to the previous pose acts
/// @throw client::ClientError  no server takes poses, or none answers for a second
[[nodiscard]] Recording run(const dds::Participant& participant, std::uint32_t tool_id, HeldDevice& device,
                            const client::ServerRun& server, const Delays* delays = nullptr);

}  // namespace palpate::device
