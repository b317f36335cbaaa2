// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/writer.h"
#include "palpate/server/facts.h"
#include "palpate/server/organ_shape.h"

namespace palpate::server {

/// The organ's rest surface on the wire, and those of its regions. DDS keeps it for late readers that ask for that
/// (transient local). Readers of default QoS are volatile and get no history: for them it is sent again, twice after each
/// new one, at most once a second.
/// Threads: one. Real-time: no.
class RestSurface {
 public:
  /// Sends it. Facts and the shape's model must outlive this. @throw dds::DdsError
  RestSurface(const dds::Participant& participant, const Facts& facts,
              std::unique_ptr<const OrganShape> shape);

  /// Sends that of another model, whose id the facts have by now; nothing of the one before is looked at any more.
  /// @return false when DDS refused it
  bool change(std::unique_ptr<const OrganShape> shape) noexcept;

  /// Sends it again if a volatile reader has come. @param[in] now_ns  our monotonic clock
  /// @return false when DDS refused it
  bool repeatIfAsked(std::int64_t now_ns) noexcept;

  /// Lets the watch compare others' endpoints with ours.
  void show(dds::EndpointWatch& watch) const { watch.add(writer_); }

 private:
  [[nodiscard]] bool write() noexcept;
  [[nodiscard]] bool hasVolatileReader() const noexcept;

  const Facts& facts_;
  std::unique_ptr<const OrganShape> shape_;
  dds::Writer<dds::SurfaceMesh> writer_;
  std::uint32_t readers_so_far_{0};
  int repeats_{0};
  std::int64_t sent_ns_{0};
};

}  // namespace palpate::server
