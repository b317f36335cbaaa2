// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/writer.h"
#include "palpate/server/channels.h"
#include "palpate/server/facts.h"

namespace palpate::server {

/// The record as a DDS sample of this server. Real-time: yes.
[[nodiscard]] dds::ToolForce toWire(const Facts& facts, const ForceRecord& record) noexcept;

/// Sends every force that the tick wrote, and says when the last ones of a server that stops, zero all, were sent.
class ForcePublisher {
 public:
  /// The references must outlive the publisher. @throw dds::DdsError
  ForcePublisher(const dds::Participant& participant, Channels& channels, const Facts& facts)
      : channels_(channels), facts_(facts), writer_(participant) {}

  /// Body of the force-out thread. Returns once the server stops and the ring is empty.
  void run() noexcept;

  /// Lets the watch compare others' endpoints with ours.
  void show(dds::EndpointWatch& watch) const { watch.add(writer_); }

 private:
  /// What the ring has.
  void sendAll() noexcept;

  Channels& channels_;
  const Facts& facts_;
  dds::Writer<dds::ToolForce> writer_;
  bool taken_{true};  // whether DDS took the newest record
  bool zero_told_{false};
};

}  // namespace palpate::server
