// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "core/data/model_view.h"

namespace palpate::modelfile {

/// Data that do not fit together, or a file that cannot be written or read. what() is one sentence.
class ModelFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Degree of the contact's answer in the file: as given, or that of the fields.
[[nodiscard]] inline int forceOrder(const ModelAttributes& a) {
  return a.force_order == 0 ? a.order : a.force_order;
}

/// Everything that a model file holds, as vectors; the writer rounds the fields to whole numbers. Shapes are row-major as in docs/model_file.md;
/// Ns surface nodes, T triangles, M contact positions, C coefficients of the fields
/// (MonomialBasis::size(order), or the number of level functions), Cm = modeCoefficients(C), n modes, N volume nodes, V tetrahedra.
/// attributes.parameters chooses the kind; what belongs to the other kinds stays empty. Stored coefficient =
/// true coefficient * d_ref^|alpha|, or f_ref^|alpha|. Indices are 0-based.
struct ModelData {
  ModelAttributes attributes;  ///< law: one of kLaws; provenance is the text of a JSON object
  /// Fields in whole numbers of 8 bits, and each array in the fewest bytes that hold its numbers: for small machines
  bool compact{false};

  std::vector<double> surface_positions;         ///< [Ns][3] m
  std::vector<std::int32_t> surface_triangles;   ///< [T][3] counter-clockwise from outside
  std::vector<std::int64_t> surface_mesh_tag;    ///< [Ns]
  std::vector<std::int32_t> position_of_node;    ///< [Ns] or -1
  std::vector<std::int32_t> contact_node;        ///< [M]
  std::vector<std::uint8_t> contact_accessible;  ///< [M] 0 or 1
  std::vector<std::int32_t> contact_triangles;   ///< [Tc][3]; empty: those of the surface
  std::vector<double> contact_force;  ///< [M][Cf][3] N, Cf = size(force_order); "displacement" only
  std::vector<double>
      contact_displacement;  ///< [M][C][3] m, d_alpha(s) as the modes give it; "force", "level"
  std::vector<double>
      contact_stiffness;  ///< [places][6][4] K_s at rest and its gradient; "displacement" only
  // Nodal Green's functions, "displacement" only: G nodes that carry load.
  std::vector<std::int32_t> green_node;            ///< [G] surface nodes that patches load, ascending
  std::vector<float> green_Y;                      ///< [G][3][n] m/N
  std::vector<std::int64_t> green_offset;          ///< [G+1]
  std::vector<std::int32_t> green_near_node;       ///< [sum Kg]
  std::vector<float> green_near;                   ///< per node [3 loads][Kg][3] m/N
  std::vector<double> contact_domain_radius;       ///< [M] d_max, m, or f_max, N, or t_max
  std::vector<double> contact_series_radius;       ///< [M] of a "displacement" model: r_max, m
  std::vector<double> levels_Z;                    ///< [C][L+1] at t = 0, 1/L .. 1; "level" only
  std::vector<float> modes_X;                      ///< [n][3 Ns]
  std::vector<float> modes_Y;                      ///< [M][Cm][nY] m, nY = positionModes()
  std::size_t position_modes{0};                   ///< nY; 0: all n
  std::vector<std::int64_t> near_offset;           ///< [M+1]
  std::vector<std::int32_t> near_node;             ///< [sum K]
  std::vector<float> near_field;                   ///< per position [Cm][K_m][3] m
  int edge_order{0};                               ///< degree of what edges add; 0: nothing
  std::vector<std::int64_t> edge_offset;           ///< [E+1], or empty
  std::vector<std::int32_t> edge_node;             ///< [sum Ke]
  std::vector<float> edge_field;                   ///< per edge [Ce][K_e][3] m
  std::vector<double> mesh_nodes;                  ///< [N][3] m
  std::vector<std::int32_t> mesh_tetrahedra;       ///< [V][4]
  std::vector<std::int32_t> mesh_midsides;         ///< [V][6] of quadratic elements, else empty
  std::vector<std::int64_t> mesh_node_tag;         ///< [N]
  std::vector<std::int64_t> mesh_tetrahedron_tag;  ///< [V]
  std::vector<std::int32_t> mesh_fixed;            ///< volume nodes
  std::vector<std::int32_t> mesh_surface_node;     ///< [Ns] volume node of a surface node
  std::vector<std::int32_t> mesh_element_region;   ///< [V] or empty: one material, that of the attributes
  std::vector<RegionName> region_name;             ///< [R] or empty, as the next three
  std::vector<double> region_E;                    ///< [R] Pa
  std::vector<double> region_nu;                   ///< [R]
  std::vector<RegionName> region_law;              ///< [R] of kLaws
  std::vector<std::int32_t> spring_node;           ///< [S] volume nodes, or empty
  std::vector<double> spring_stiffness;            ///< [S] N/m
};

/// Ce, coefficients of what edges add.
[[nodiscard]] inline std::size_t edgeCoefficients(const ModelData& d) {
  return d.edge_order < 2 ? 0
                          : static_cast<std::size_t>(MonomialBasis::size(d.edge_order)) - kLinearCoefficients;
}

/// n, the number of modes; 0 without a surface.
[[nodiscard]] inline std::size_t modeCount(const ModelData& d) {
  return d.surface_mesh_tag.empty() ? 0 : d.modes_X.size() / (3 * d.surface_mesh_tag.size());
}

/// nY, the modes, the first, that contact positions have amplitudes of.
[[nodiscard]] inline std::size_t positionModes(const ModelData& d) {
  return d.position_modes == 0 ? modeCount(d) : d.position_modes;
}

}  // namespace palpate::modelfile
