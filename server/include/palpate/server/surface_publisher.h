// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/tick/shown_surface.h"
#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/writer.h"
#include "palpate/server/channels.h"
#include "palpate/server/facts.h"

namespace palpate::server {

/// Evaluates and sends the surface's displacement where the tick hands over what it is made of. Tells the tick whether
/// anybody reads it, and whether it overflowed.
class SurfacePublisher {
 public:
  /// Model, channels and facts must outlive the publisher. Allocates the field's memory. @throw dds::DdsError
  SurfacePublisher(const dds::Participant& participant, const MetaModel& model, Channels& channels,
                   const Facts& facts)
      : channels_(channels), facts_(facts), surface_(model), displacement_(participant) {}

  /// Body of the surface-out thread. Returns once the server stops.
  void run() noexcept;

  /// Lets the watch compare others' endpoints with ours.
  void show(dds::EndpointWatch& watch) const { watch.add(displacement_); }

 private:
  void publish(const SurfaceSample& sample) noexcept;

  Channels& channels_;
  const Facts& facts_;
  ShownSurface surface_;
  dds::Writer<dds::SurfaceDisplacement> displacement_;
};

}  // namespace palpate::server
