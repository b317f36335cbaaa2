// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/writer.h"
#include "palpate/server/facts.h"
#include "palpate/server/health.h"

namespace palpate::server {

/// @param[in] state  one of dds::server_state
[[nodiscard]] dds::ServerStatus toWire(const Facts& facts, const Health& health, std::uint32_t state);

/// Sends ServerStatus.
class StatusPublisher {
 public:
  /// `facts` must outlive the publisher. @throw dds::DdsError
  StatusPublisher(const dds::Participant& participant, const Facts& facts)
      : facts_(facts), writer_(participant) {}

  void publish(const Health& health, std::uint32_t state) {
    (void)writer_.write(toWire(facts_, health, state));
  }
  [[nodiscard]] const Facts& facts() const noexcept { return facts_; }

  /// Lets the watch compare others' endpoints with ours.
  void show(dds::EndpointWatch& watch) const { watch.add(writer_); }

 private:
  const Facts& facts_;
  dds::Writer<dds::ServerStatus> writer_;
};

}  // namespace palpate::server
