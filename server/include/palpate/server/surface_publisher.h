// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/core/meta_model.h"
#include "palpate/idl/writer.h"
#include "palpate/server/channels.h"
#include "palpate/server/facts.h"

namespace palpate::server {

/// Sends the rest surface once, kept for late readers, then each displacement that the tick publishes.
class SurfacePublisher {
 public:
  /// Publishes the rest surface. Both references must outlive the publisher.
  /// @throw dds::DdsError
  SurfacePublisher(const dds::Participant& participant, Channels& channels, const Facts& facts,
                   const MetaModel& model);

  /// Body of the surface-out thread. Returns once the server stops.
  void run() noexcept;

 private:
  void publishRestSurface(const MetaModel& model);
  void publish(const SurfaceSample& frame) noexcept;

  Channels& channels_;
  const Facts& facts_;
  dds::Writer<dds::SurfaceMesh> rest_;
  dds::Writer<dds::SurfaceDisplacement> displacement_;
};

}  // namespace palpate::server
