// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "palpate/idl/reader.h"
#include "palpate/server/channels.h"

namespace palpate::server {

/// Books poses as they arrive: checks their order, and hands each tool's newest to the tick. It judges
/// nothing else; what a pose says is the engine's business. Threads: one at a time (Cyclone's callback of one
/// reader). Real-time: yes, no allocation of ours.
class PoseIntake {
 public:
  explicit PoseIntake(Channels& channels) : channels_(channels) {}

  /// @param[in] arrival_ns  our monotonic clock
  void accept(const dds::ToolPose& pose, std::int64_t arrival_ns) noexcept PALPATE_NONBLOCKING;

 private:
  Channels& channels_;
  std::array<PoseSample, kMaxTools> newest_{};
  std::uint64_t unknown_tools_{0};
};

/// Takes tool poses from DDS on its receive thread.
class PoseSubscriber {
 public:
  /// @throw dds::DdsError
  PoseSubscriber(const dds::Participant& participant, Channels& channels)
      : intake_(channels), reader_(participant, &PoseSubscriber::onPoses, &intake_) {}

 private:
  static void onPoses(dds::ReaderView<dds::ToolPose> reader, void* context) noexcept;

  PoseIntake intake_;
  dds::Reader<dds::ToolPose> reader_;  // last: its callback uses the intake
};

}  // namespace palpate::server
