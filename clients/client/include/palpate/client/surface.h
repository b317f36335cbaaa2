// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/devices/path/path.h"
#include "palpate/idl/types.h"

namespace palpate::client {

/// A part of the organ with a material of its own.
struct Region {
  std::string name;
  double youngs_modulus{0.0};            ///< E of the model, Pa
  std::vector<device::Point> positions;  ///< of its surface to larger regions at rest, m; may be empty
  std::vector<std::array<std::uint32_t, 3>>
      triangles;  ///< 0-based, counter-clockwise from outside the region
};

/// The organ's rest surface as a client keeps it.
struct Surface {
  std::uint32_t organ_id{0};
  std::uint64_t session{0};  ///< of its server
  std::string model_id;
  std::uint32_t topology_revision{0};
  std::vector<device::Point> positions;                 ///< Ns rest positions X, m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< T, 0-based, counter-clockwise from outside
  std::vector<std::uint8_t> accessible;                 ///< Ns, 1 = may be touched
  std::vector<std::int64_t> mesh_tags;                  ///< Ns node numbers in the mesh file
  std::vector<std::uint8_t> clamped;                    ///< Ns, 1 = does not move
  std::vector<Region> regions;                          ///< empty: one material
  double contact_radius{0.0};                           ///< as on the wire, m; 0: not said
  std::string certificate;                              ///< one line; empty: not said
};

/// Checks and copies a surface from the wire; its sender is not trusted.
/// @throw ClientError naming the field and the number: sizes that differ, an index out of range, a non-finite
///        position, no triangle, a region without stiffness, a radius below 0, a text that is not printable ASCII
[[nodiscard]] Surface checkedSurface(const dds::SurfaceMesh& message);

/// A place on the surface for a tool to touch.
struct Spot {
  std::uint32_t node{0};  ///< 0-based surface node
  std::int64_t mesh_tag{0};
  device::Point position{};  ///< X, m
  device::Point normal{};    ///< outward unit normal there, angle-weighted over the triangles around
};

/// The accessible node nearest to `at`, or the highest one (+z) when `at` is absent. Nodes whose neighbours are
/// all accessible come first.
/// @throw ClientError  no node is accessible, or the surface has no normal there
[[nodiscard]] Spot chooseSpot(const Surface& surface, const std::optional<device::Point>& at);

}  // namespace palpate::client
