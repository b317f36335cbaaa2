// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::client {

/// Tries to give this thread the real-time scheduler SCHED_FIFO.
/// @param[in] priority  1 to 99; stay below the server's 80 when both share a machine
/// @return whether it was granted
/// Real-time: no.
[[nodiscard]] bool raiseThisThread(int priority) noexcept;

/// The same for the threads in which Cyclone DDS receives (named recv...), once a participant exists; its
/// configuration cannot do it (docs/design.md, Wire).
/// @return how many were raised
int raiseReceiveThreads(int priority) noexcept;

}  // namespace palpate::client
