// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace palpate {

/// Root attributes of a model file.
struct ModelAttributes {
  std::string model_id;                ///< hexadecimal hash of content and case
  std::string law;                     ///< "stvk"
  std::string provenance;              ///< text of a JSON object: who made it, from what, how well it fits
  double E{0.0};                       ///< Young's modulus, Pa, > 0
  double nu{0.0};                      ///< Poisson's ratio, in (-1, 0.5)
  int order{0};                        ///< p, highest degree of the fields, 1 to MonomialBasis::kMaxOrder
  double patch_radius{0.0};            ///< a, m, > 0
  double near_radius{0.0};             ///< rho, m, >= 0
  double reference_displacement{0.0};  ///< d_ref, m, > 0: every polynomial is one in d / d_ref
  int force_order{0};                  ///< highest degree of the force, p to kMaxOrder; writers take 0 for p
};

/// The numbers of a model file where they lie in memory. Shapes are row-major; Ns surface nodes, T triangles,
/// M contact positions, C = size(order) coefficients, Cf = size(force_order), n modes, N volume nodes, V
/// tetrahedra. Borrowed: valid as long as the model.
struct ModelView {
  std::span<const double> surface_positions;        ///< [Ns][3] m
  std::span<const std::int32_t> surface_triangles;  ///< [T][3] counter-clockwise from outside
  std::span<const std::int64_t> surface_mesh_tag;   ///< [Ns] node number in the mesh file
  std::span<const std::int32_t> position_of_node;   ///< [Ns] contact position of a surface node, or -1
  std::span<const std::int32_t> contact_node;       ///< [M] surface node of a contact position
  std::span<const std::uint8_t>
      contact_accessible;                 ///< [M] 1: accessible; 0: helper for interpolation beside it
  std::span<const double> contact_force;  ///< [M][Cf][3] f_alpha d_ref^|alpha|, N
  std::span<const double> contact_domain_radius;       ///< [M] d_max, m
  std::span<const float> modes_X;                      ///< [n][Ns][3] dimensionless
  std::span<const float> modes_Y;                      ///< [M][C][n] scaled, m
  std::span<const std::int64_t> near_offset;           ///< [M+1] prefix sums of the near nodes' counts
  std::span<const std::int32_t> near_node;             ///< [sum K] surface nodes
  std::span<const float> near_field;                   ///< per position [C][K_m][3], windowed, scaled, m
  std::span<const double> mesh_nodes;                  ///< [N][3] m
  std::span<const std::int32_t> mesh_tetrahedra;       ///< [V][4]
  std::span<const std::int64_t> mesh_node_tag;         ///< [N]
  std::span<const std::int64_t> mesh_tetrahedron_tag;  ///< [V]
  std::span<const std::int32_t> mesh_fixed;            ///< volume nodes
  std::span<const std::int32_t> mesh_surface_node;     ///< [Ns] volume node of a surface node

  [[nodiscard]] std::size_t surfaceNodes() const noexcept { return surface_mesh_tag.size(); }
  [[nodiscard]] std::size_t triangles() const noexcept { return surface_triangles.size() / 3; }
  [[nodiscard]] std::size_t positions() const noexcept { return contact_node.size(); }
  [[nodiscard]] std::size_t modes() const noexcept {
    return surface_mesh_tag.empty() ? 0 : modes_X.size() / (3 * surface_mesh_tag.size());
  }
};

}  // namespace palpate
