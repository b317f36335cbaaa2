// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

#include <array>
#include <span>
#include <string>

#include "palpate/client/status_board.h"
#include "palpate/client/tool_client.h"

namespace palpate::client {

/// What a program says when SendingPriority::granted() is false.
inline constexpr const char* kNotRealtime =
    "note: no real-time priority for sending poses (needs CAP_SYS_NICE or an rtprio limit)\n";

/// The priority with which a thread sends poses, below the server's threads, so that a client on the same machine does
/// not delay it (docs/design.md, Threads). The thread that made it ends it and is then as before: what a program
/// computes of the answers keeps no other from a processor. Real-time: no.
class SendingPriority {
 public:
  /// Waits until a server takes the poses of all these tools, which the calling thread sends, then raises it and, for
  /// good, the receiving ones. @throw ClientError  no server within 5 s
  explicit SendingPriority(std::span<const ToolClient* const> tools);
  explicit SendingPriority(const ToolClient& tool) : SendingPriority(std::array{&tool}) {}
  ~SendingPriority();
  SendingPriority(const SendingPriority&) = delete;
  SendingPriority& operator=(const SendingPriority&) = delete;

  /// Whether the system granted the thread its priority.
  [[nodiscard]] bool granted() const noexcept { return granted_; }

 private:
  int policy_{0};
  sched_param parameters_{};  // and policy: before
  bool granted_{false};
};

/// "12 forces of another server were left out: server 3, ...\n"; empty: none were. Real-time: no.
[[nodiscard]] std::string leftOutText(const LeftOut& left_out, const StatusBoard& statuses);

}  // namespace palpate::client
