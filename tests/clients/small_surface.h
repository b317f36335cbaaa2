// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palpate/idl/types.h"

namespace palpate::testing {

/// A pyramid on a square, 0.1 m wide and 0.05 m high, the apex (node 4) on top; every node but node 0 is
/// accessible. Owns the memory that message() points into.
struct SmallSurface {
  std::vector<double> positions{0, 0, 0, 0.1, 0, 0, 0.1, 0.1, 0, 0, 0.1, 0, 0.05, 0.05, 0.05};
  std::vector<std::uint32_t> triangles{0, 2, 1, 0, 3, 2, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
  std::vector<std::uint8_t> accessible{0, 1, 1, 1, 1};
  std::vector<std::int64_t> mesh_tags{11, 12, 13, 14, 15};
  std::vector<std::uint8_t> clamped{1, 0, 0, 0, 0};
  std::vector<dds::Region> regions;
  std::string model_id{"0123456789abcdef"};
  double contact_radius{0.006};
  std::string certificate{"not certified: it is a pyramid"};

  [[nodiscard]] dds::SurfaceMesh message() {
    dds::SurfaceMesh mesh{};
    dds::assignText(mesh.model_id, model_id);
    const auto size = [](const auto& v) { return static_cast<std::uint32_t>(v.size()); };
    mesh.positions = {size(positions), size(positions), positions.data(), false};
    mesh.triangles = {size(triangles), size(triangles), triangles.data(), false};
    mesh.accessible = {size(accessible), size(accessible), accessible.data(), false};
    mesh.mesh_tags = {size(mesh_tags), size(mesh_tags), mesh_tags.data(), false};
    mesh.clamped = {size(clamped), size(clamped), clamped.data(), false};
    mesh.regions = {size(regions), size(regions), regions.data(), false};
    mesh.contact_radius = contact_radius;
    dds::assignText(mesh.certificate, certificate);
    return mesh;
  }

  /// What it is made of, and in it a triangle of another tissue.
  void addRegions() {
    dds::Region around{}, nodule{};
    dds::assignText(around.name, "elsewhere");
    around.youngs_modulus = 5e3;
    dds::assignText(nodule.name, "nodule");
    nodule.youngs_modulus = 70e3;
    dds::lend(nodule.positions, region_positions.data(), region_positions.size());
    dds::lend(nodule.triangles, region_triangles.data(), region_triangles.size());
    regions = {around, nodule};
  }
  std::vector<double> region_positions{0.04, 0.04, 0.01, 0.06, 0.04, 0.01, 0.05, 0.06, 0.02};
  std::vector<std::uint32_t> region_triangles{0, 1, 2};
};

}  // namespace palpate::testing
