// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/idl/writer.h"
#include "palpate/server/channels.h"

namespace palpate::server {

/// The record as a DDS sample. Real-time: yes.
[[nodiscard]] dds::ToolForce toWire(const ForceRecord& record) noexcept;

/// Sends every force that the tick wrote.
class ForcePublisher {
 public:
  /// @throw dds::DdsError
  ForcePublisher(const dds::Participant& participant, Channels& channels)
      : channels_(channels), writer_(participant) {}

  /// Body of the force-out thread. Returns once the server stops and the ring is empty.
  void run() noexcept;

 private:
  Channels& channels_;
  dds::Writer<dds::ToolForce> writer_;
};

}  // namespace palpate::server
