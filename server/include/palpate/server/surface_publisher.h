// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/writer.h"
#include "palpate/server/channels.h"
#include "palpate/server/engine.h"
#include "palpate/server/facts.h"

namespace palpate::server {

/// Evaluates and sends the surface's displacement where the tick hands over what it is made of. Tells the tick whether
/// anybody reads it, and whether it overflowed. After each field it rests for as long as that took to compute and send, 0.1 s at
/// most, so that it has at most half of a processor (docs/decisions/surface_rate.md).
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
  void publish(const SurfaceSample& sample) noexcept;
  void letGo(std::uint64_t in_use) noexcept;
  static void rest(std::int64_t computed_ns) noexcept;

  Channels& channels_;
  const Facts& facts_;
  Engine* engine_{nullptr};  // whose surface was shown last; none: the one in use has shown nothing yet
  dds::Writer<dds::SurfaceDisplacement> displacement_;
};

}  // namespace palpate::server
