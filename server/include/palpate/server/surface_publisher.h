// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/writer.h"
#include "palpate/server/channels.h"
#include "palpate/server/facts.h"

namespace palpate::server {

/// Sends each displacement that the tick publishes. Tells the tick whether anybody reads them.
class SurfacePublisher {
 public:
  /// Channels and facts must outlive the publisher. @throw dds::DdsError
  SurfacePublisher(const dds::Participant& participant, Channels& channels, const Facts& facts)
      : channels_(channels), facts_(facts), displacement_(participant) {}

  /// Body of the surface-out thread. Returns once the server stops.
  void run() noexcept;

  /// Lets the watch compare others' endpoints with ours.
  void show(dds::EndpointWatch& watch) const { watch.add(displacement_); }

 private:
  void publish(const SurfaceSample& frame) noexcept;

  Channels& channels_;
  const Facts& facts_;
  dds::Writer<dds::SurfaceDisplacement> displacement_;
};

}  // namespace palpate::server
