// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/data/model_view.h"
#include "core/data/region_surfaces.h"
#include "core/model/meta_model.h"
#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/writer.h"
#include "palpate/server/facts.h"

namespace palpate::server {

/// The organ's rest surface on the wire, and those of its regions. DDS keeps it for late readers that ask for that
/// (transient local). Readers of default QoS are volatile and get no history: for them it is sent again, twice after each
/// new one, at most once a second.
/// Threads: one. Real-time: no.
class RestSurface {
 public:
  /// Sends it. Facts and model must outlive this. @throw dds::DdsError
  RestSurface(const dds::Participant& participant, const Facts& facts, const MetaModel& model);

  /// Sends it again if a volatile reader has come. @param[in] now_ns  our monotonic clock
  /// @return false when DDS refused it
  bool repeatIfAsked(std::int64_t now_ns) noexcept;

  /// Lets the watch compare others' endpoints with ours.
  void show(dds::EndpointWatch& watch) const { watch.add(writer_); }

 private:
  [[nodiscard]] bool write() noexcept;
  [[nodiscard]] bool hasVolatileReader() const noexcept;

  const Facts& facts_;
  const ModelView& view_;
  double contact_radius_;  // m
  std::string certificate_;
  std::vector<std::uint32_t> triangles_;
  std::vector<std::uint8_t> accessible_;
  std::vector<std::uint8_t> clamped_;
  std::vector<RegionSurface> region_surfaces_;
  std::vector<dds::Region> regions_;  // borrow from these
  dds::Writer<dds::SurfaceMesh> writer_;
  std::uint32_t readers_so_far_{0};
  int repeats_{0};
  std::int64_t sent_ns_{0};
};

}  // namespace palpate::server
