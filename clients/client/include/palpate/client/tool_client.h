// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "core/devices/path/path.h"
#include "palpate/client/model_changes.h"
#include "palpate/client/server_hold.h"
#include "palpate/idl/tap.h"
#include "palpate/idl/writer.h"
#include "palpate/rt/triple_buffer.h"

namespace palpate::client {

/// One haptic tool as the server sees it: sends its poses, receives the forces on it. Device drivers build on it. It holds on to
/// one server (ServerHold): the one that is named, or else the first that answers. Its poses name that server, and forces of
/// others are left out.
class ToolClient {
 public:
  /// Called for every answer to this tool, on Cyclone's receive thread: must not block or throw.
  /// @param[in] received_ns  rt::monotonicNow() on arrival
  using ForceCallback = void (*)(const dds::ToolForce& force, std::int64_t received_ns,
                                 void* context) noexcept;

  /// @param[in] tool_id  0 to 3, one client for each
  /// @param[in] wanted   the server; by default the first that answers
  /// @throw ClientError for another id, dds::DdsError
  /// Real-time: no. The participant, and what `context` points to, must outlive it.
  ToolClient(const dds::Participant& participant, std::uint32_t tool_id, ForceCallback callback = nullptr,
             void* context = nullptr, const ServerRun& wanted = {});
  ToolClient(const ToolClient&) = delete;
  ToolClient& operator=(const ToolClient&) = delete;

  /// Sends the next pose, stamped now.
  /// @param[in] position     p_WT, m
  /// @param[in] orientation  q_WT, x y z w, unit length
  /// @return its seq, which starts at the clock, so that a restarted client stays ahead of its old poses; 0 when
  ///         DDS refused the pose
  /// No allocation of ours (Cyclone's own: docs/design.md, Threads). Threads: one.
  std::uint64_t publish(const device::Point& position,
                        const std::array<double, 4>& orientation = {0, 0, 0, 1},
                        std::uint32_t buttons = 0) noexcept;

  /// The newest answer, unless an earlier call gave it: then false, and `force` is unchanged. Real-time: yes. Threads: one, any.
  [[nodiscard]] bool latest(dds::ToolForce& force) noexcept {
    if (!latest_.update()) return false;
    force = latest_.front();
    return true;
  }

  /// Poses go to this server from here on, and its forces are taken, once the held one is gone. Threads: any. Real-time: yes.
  void want(std::uint32_t server_id) noexcept { hold_.want(server_id); }

  /// The server that is held on to, and what others sent. Threads: any.
  [[nodiscard]] const ServerHold& hold() const noexcept { return hold_; }

  /// How often the held server took another model while it answered. Threads: any.
  [[nodiscard]] std::uint64_t modelChanges() const noexcept { return models_.count(); }

  /// @return whether, within `timeout`, a server listens to the poses and a server sends forces
  [[nodiscard]] bool waitForServer(std::chrono::milliseconds timeout) const noexcept;
  /// One line when a server is there whose endpoints do not match: by which policies, and whose they are; else empty.
  /// Real-time: no.
  [[nodiscard]] std::string mismatch() const;

 private:
  static void onForce(const dds::ToolForce& force, dds::WriterId writer, void* context) noexcept;
  [[nodiscard]] bool answersUs(const dds::ToolForce& force) const noexcept;

  std::uint32_t tool_id_;
  std::uint64_t first_seq_;
  dds::ToolPose pose_{};                 // publish()'s only
  std::atomic<std::uint64_t> last_seq_;  // publish() writes, the receive thread reads; orders nothing else
  ForceCallback callback_;
  void* context_;
  rt::TripleBuffer<dds::ToolForce> latest_;  // written by the receive thread, read by latest()'s caller
  ServerHold hold_;
  ModelChanges models_;
  dds::Writer<dds::ToolPose> poses_;
  dds::Tap<dds::ToolForce> forces_;  // last: no callback comes after it is destroyed
};

}  // namespace palpate::client
