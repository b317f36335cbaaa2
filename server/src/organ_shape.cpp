// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/organ_shape.h"

#include "core/model/contact_radius.h"
#include "tools/program/certificate_line.h"

namespace palpate::server {
namespace {

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

OrganShape::OrganShape(const MetaModel& model)
    : view_(model.view()),
      contact_radius_(contactRadius(model)),
      certificate_(program::certificateLine(model.attributes().certificate)),
      triangles_(view_.surface_triangles.begin(), view_.surface_triangles.end()),
      accessible_(model.accessibleNodes()),
      clamped_(model.clampedNodes()),
      region_surfaces_(regionSurfaces(view_)),
      regions_(regionsOf(view_, region_surfaces_)) {}

void OrganShape::lendTo(dds::SurfaceMesh& mesh) const {
  dds::lend(mesh.positions, view_.surface_positions.data(), view_.surface_positions.size());
  dds::lend(mesh.triangles, triangles_.data(), triangles_.size());
  dds::lend(mesh.accessible, accessible_.data(), accessible_.size());
  dds::lend(mesh.mesh_tags, view_.surface_mesh_tag.data(), view_.surface_mesh_tag.size());
  dds::lend(mesh.clamped, clamped_.data(), clamped_.size());
  dds::lend(mesh.regions, regions_.data(), regions_.size());
  mesh.contact_radius = contact_radius_;
  dds::assignText(mesh.certificate, certificate_);
}

}  // namespace palpate::server
