// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palpate/client/status_board.h"
#include "palpate/client/tool_client.h"

namespace palpate::client {

/// What a program says when prepareToSend() returns false.
inline constexpr const char* kNotRealtime =
    "note: no real-time priority for sending poses (needs CAP_SYS_NICE or an rtprio limit)\n";

/// Waits until a server takes the tool's poses, then raises the calling thread and the receiving threads. They stay below
/// the server's threads, so that a client on the same machine does not delay it (docs/design.md, Threads).
/// @return whether the calling thread got its priority
/// @throw ClientError  no server within 5 s
/// Real-time: no.
[[nodiscard]] bool prepareToSend(const ToolClient& tool);

/// "12 forces of another server were left out: server 3, ...\n"; empty: none were. Real-time: no.
[[nodiscard]] std::string leftOutText(const LeftOut& left_out, const StatusBoard& statuses);

}  // namespace palpate::client
