// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/rest_surface.h"

#include <algorithm>
#include <array>

#include "core/model/contact_radius.h"
#include "palpate/idl/error.h"
#include "palpate/rt/clock.h"
#include "tools/program/certificate_line.h"

namespace palpate::server {
namespace {

constexpr std::int64_t kShortestPause = 1'000'000'000;  // ns
constexpr int kRepeats = 2;                             // a best-effort reader may lose one

bool isVolatile(dds_entity_t writer, dds_instance_handle_t reader) noexcept {
  dds_builtintopic_endpoint_t* found = dds_get_matched_subscription_data(writer, reader);
  if (found == nullptr) return false;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  (void)dds_qget_durability(found->qos, &durability);
  dds_builtintopic_free_endpoint(found);
  return durability == DDS_DURABILITY_VOLATILE;
}

/// The regions that have tetrahedra: of "elsewhere" there may be none.
std::vector<dds::Region> regionsOf(const ModelView& view, const std::vector<RegionSurface>& surfaces) {
  std::vector<dds::Region> regions;
  for (std::size_t r = 0; r < surfaces.size(); ++r) {
    if (surfaces[r].tetrahedra == 0) continue;
    dds::Region region{};
    dds::assignText(region.name, textOf(view.region_name[r]));
    region.youngs_modulus = view.region_E[r];
    dds::lend(region.positions, surfaces[r].positions.data(), surfaces[r].positions.size());
    dds::lend(region.triangles, surfaces[r].triangles.data(), surfaces[r].triangles.size());
    regions.push_back(region);
  }
  return regions;
}

}  // namespace

RestSurface::RestSurface(const dds::Participant& participant, const Facts& facts, const MetaModel& model)
    : facts_(facts),
      view_(model.view()),
      contact_radius_(contactRadius(model)),
      certificate_(program::certificateLine(model.attributes().certificate)),
      triangles_(view_.surface_triangles.begin(), view_.surface_triangles.end()),
      accessible_(model.accessibleNodes()),
      clamped_(model.clampedNodes()),
      region_surfaces_(regionSurfaces(view_)),
      regions_(regionsOf(view_, region_surfaces_)),
      writer_(participant) {
  if (!write()) throw dds::DdsError("cannot publish the rest surface");
  sent_ns_ = rt::monotonicNow();
}

bool RestSurface::repeatIfAsked(std::int64_t now_ns) noexcept {
  if (now_ns - sent_ns_ < kShortestPause) return true;
  dds_publication_matched_status_t matched{};
  (void)dds_get_publication_matched_status(writer_.handle(), &matched);
  if (matched.total_count != readers_so_far_ && hasVolatileReader()) repeats_ = kRepeats;
  readers_so_far_ = matched.total_count;
  if (repeats_ == 0) return true;
  --repeats_;
  sent_ns_ = now_ns;
  return write();
}

bool RestSurface::hasVolatileReader() const noexcept {
  std::array<dds_instance_handle_t, 64> readers{};
  const dds_return_t count = dds_get_matched_subscriptions(writer_.handle(), readers.data(), readers.size());
  const auto looked_at =
      std::min<std::size_t>(count > 0 ? static_cast<std::size_t>(count) : 0, readers.size());
  return std::any_of(readers.begin(), readers.begin() + static_cast<std::ptrdiff_t>(looked_at),
                     [this](dds_instance_handle_t reader) { return isVolatile(writer_.handle(), reader); });
}

bool RestSurface::write() noexcept {
  dds::SurfaceMesh mesh{};
  mesh.organ_id = facts_.organ_id;
  mesh.session = facts_.session;
  dds::assignText(mesh.model_id, facts_.model_id);
  dds::lend(mesh.positions, view_.surface_positions.data(), view_.surface_positions.size());
  dds::lend(mesh.triangles, triangles_.data(), triangles_.size());
  dds::lend(mesh.accessible, accessible_.data(), accessible_.size());
  dds::lend(mesh.mesh_tags, view_.surface_mesh_tag.data(), view_.surface_mesh_tag.size());
  dds::lend(mesh.clamped, clamped_.data(), clamped_.size());
  dds::lend(mesh.regions, regions_.data(), regions_.size());
  mesh.contact_radius = contact_radius_;
  dds::assignText(mesh.certificate, certificate_);
  return writer_.write(mesh);
}

}  // namespace palpate::server
