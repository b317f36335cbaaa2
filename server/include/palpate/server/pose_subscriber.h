// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/tick/step_config.h"
#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/reader.h"
#include "palpate/server/channels.h"

namespace palpate::server {

/// The first distinct tool ids above 3, at most kMaxUnknownTools: a client that invents ids cannot fill memory.
/// Threads: one.
class UnknownIds {
 public:
  /// @return the id's place, the same ever after; nothing when it is new and there is no room
  [[nodiscard]] std::optional<std::size_t> place(std::uint32_t tool_id) noexcept PALPATE_NONBLOCKING;

 private:
  std::array<std::uint32_t, kMaxUnknownTools> ids_{};
  std::size_t count_{0};
};

/// Which poses are meant for this server.
struct Address {
  std::uint32_t server_id{0};
  bool answers_any{true};  ///< also those for dds::kServerAny
};

/// Books poses as they arrive: who sends a tool's poses, whether they come in order, which tools get no force; and
/// hands each tool's newest pose to the tick. The engine judges the pose itself.
/// A tool belongs to the publisher of its first pose until that is gone, or none of its poses came for zero_after, when the
/// force is zero anyway. Until then the poses of others are not used, and counted when a pose of the owner follows them: an
/// owner that ended has no rival (docs/decisions/tool_ownership.md).
/// Threads: one at a time (Cyclone's callback of one reader), left() from any. Real-time: yes, no allocation of ours.
class PoseIntake {
 public:
  /// @param[in] config  tools and zero_after are used
  PoseIntake(Channels& channels, const StepConfig& config, const Address& address = {})
      : channels_(channels),
        address_(address),
        tools_(static_cast<std::uint32_t>(config.tools)),
        silence_ns_(static_cast<std::int64_t>(1e9 * config.zero_after)) {}

  /// @param[in] writer      who sent it
  /// @param[in] arrival_ns  our monotonic clock
  void accept(const dds::ToolPose& pose, dds::WriterId writer,
              std::int64_t arrival_ns) noexcept PALPATE_NONBLOCKING;

  /// The writer is gone: its tools go to the publisher of the next pose.
  void left(dds::WriterId writer) noexcept;

  /// Whether DDS shall keep a pose for us: it is for this server, and its tool is known or there is room to answer it. One call at a time, but possibly during an accept().
  [[nodiscard]] bool admits(const dds::ToolPose& pose) noexcept PALPATE_NONBLOCKING;

 private:
  void acceptServed(const dds::ToolPose& pose, dds::WriterId writer,
                    std::int64_t arrival_ns) noexcept PALPATE_NONBLOCKING;
  void acceptStranger(const dds::ToolPose& pose, std::int64_t arrival_ns) noexcept PALPATE_NONBLOCKING;
  void noteUnknown(std::uint32_t tool_id) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool keepsOut(std::size_t tool, dds::WriterId writer,
                              std::int64_t arrival_ns) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool isForUs(const dds::ToolPose& pose) const noexcept PALPATE_NONBLOCKING;

  Channels& channels_;
  Address address_;
  std::uint32_t tools_;
  std::int64_t silence_ns_;
  std::array<PoseSample, kMaxTools> newest_{};
  std::array<dds::WriterId, kMaxTools> owner_{};
  // An owner that is gone. DDS's discovery thread sets it; accept() reads it, and clears it when the owner sends again after
  // a silence. Relaxed, it orders nothing.
  std::array<std::atomic<dds::WriterId>, kMaxTools> left_{};
  struct Foreign {
    std::uint64_t count{0};
    std::int64_t last_ns{0};
  };
  std::array<Foreign, kMaxTools> foreign_{};  // since the owner's last pose
  Strangers strangers_{};
  UnknownIds answered_;  // accept()'s
  UnknownIds admitted_;  // admits()'
};

/// How long a pose was on its way, ns. @param[in] sent_ns  the stamp from the wire, of the sender's wall clock: anything
/// @param[in] now_ns  the same clock, if it runs on this host
/// @return nothing where that is no delay: the clock was set, or no time was stamped
[[nodiscard]] std::optional<std::int64_t> delayOf(std::int64_t sent_ns, std::int64_t now_ns) noexcept;

/// Takes tool poses from DDS on its receive thread.
class PoseSubscriber {
 public:
  /// @throw dds::DdsError
  PoseSubscriber(const dds::Participant& participant, Channels& channels, const StepConfig& config,
                 const Address& address)
      : channels_(channels),
        intake_(channels, config, address),
        reader_(participant, &PoseSubscriber::onPoses, this, &PoseSubscriber::admits,
                &PoseSubscriber::onGone) {}

  /// Lets the watch compare others' endpoints with ours.
  void show(dds::EndpointWatch& watch) const { watch.add(reader_); }
  /// The reader, which knows the poses' writers.
  [[nodiscard]] dds_entity_t handle() const noexcept { return reader_.handle(); }

 private:
  static void onPoses(dds::ReaderView<dds::ToolPose> reader, void* context) noexcept;
  static void onGone(dds::WriterId writer, void* context) noexcept;
  static bool admits(const dds::ToolPose& pose, void* context) noexcept;

  void noteDelay(const dds::ToolPose& pose, dds::WriterId writer, std::int64_t sent_ns) noexcept;

  Channels& channels_;
  PoseIntake intake_;
  dds::Reader<dds::ToolPose> reader_;  // last: its callback uses the rest
};

}  // namespace palpate::server
