// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/multi_index.h"
#include "core/base/whole_numbers.h"
#include "core/data/datasets.h"

namespace palpate {

/// What is prescribed at the contact: the parameter of a model beside s.   docs/design.md, Reproduction, Series
enum class Parameters {
  kDisplacement,  ///< the patch displacement d: u(X; s, d), f(s, d); near field beside the modes
  kForce,         ///< the tool's force f: u(X; s, f), d(s, f)
  kLevel          ///< the level t of a load of fixed direction: u(X; s, t), d(s, t)
};

/// As the file names them: "displacement", "force", "level".
[[nodiscard]] constexpr std::string_view toString(Parameters parameters) noexcept {
  switch (parameters) {
    case Parameters::kDisplacement:
      return "displacement";
    case Parameters::kForce:
      return "force";
    case Parameters::kLevel:
      return "level";
  }
  return "unknown";
}

/// The laws of the material that model files may name. The solver's MaterialLaw says what they are.
inline constexpr std::array<std::string_view, 2> kLaws{"stvk", "stable-neo-hookean"};

/// Most triangles that a file may ask for of the rounded surface.
inline constexpr int kMostRoundedTriangles = 300'000;

/// Most functions of a level, as many as fields of the highest degree have monomials.
inline constexpr int kMostLevelFunctions = MonomialBasis::size(kMostOrder);

/// Root attributes of a model file.
struct ModelAttributes {
  std::string law;           ///< one of kLaws
  std::string provenance;    ///< text of a JSON object: who made it, from what, how well it fits
  double E{0.0};             ///< Young's modulus, Pa, > 0
  double nu{0.0};            ///< Poisson's ratio, in (-1, 0.5)
  int order{0};              ///< p, highest degree of the fields, 1 to kMostOrder; unused (0) for "level"
  double patch_radius{0.0};  ///< a, m, > 0
  double near_radius{0.0};   ///< rho, m, >= 0
  /// d_ref, m, > 0: polynomials of "displacement" models are ones in d / d_ref; else the organ's scale only
  double reference_displacement{0.0};
  int force_order{0};  ///< highest degree of the contact's answer, p to kMostForceOrder; writers take 0 for p
  Parameters parameters{Parameters::kDisplacement};
  double reference_force{0.0};             ///< f_ref, N, > 0 for "force": polynomials are ones in f / f_ref
  std::array<double, 3> load_direction{};  ///< unit vector, for "level"
  double load{0.0};                        ///< N, > 0 for "level": f = t load load_direction
  /// Most triangles of the rounded surface that tools slide on, 1 to kMostRoundedTriangles (ContactSurface)
  int rounded_triangles{kMostRoundedTriangles};
  /// Text of a JSON object, what this content was found to hold to; empty: nothing is known
  std::string certificate{};
};

/// Numbers of the patch's stiffness at one place: 6 entries of K, each with its gradient.
inline constexpr std::size_t kStiffnessNumbers = 24;
/// Coefficients of degree 1.
inline constexpr std::size_t kLinearCoefficients = 3;

/// Of `coefficients` of the fields those that modes and near fields have: nodal Green's functions give degree 1 of a
/// "displacement" model.
[[nodiscard]] constexpr std::size_t modeCoefficients(const ModelAttributes& a,
                                                     std::size_t coefficients) noexcept {
  return a.parameters == Parameters::kDisplacement ? coefficients - kLinearCoefficients : coefficients;
}

/// The numbers of a model file where they lie in memory. Shapes are row-major; Ns surface nodes, T triangles,
/// M contact positions, C coefficients of the fields (size(order), or the number of level functions), Cf =
/// size(force_order), L steps of the level, n modes, N volume nodes, V tetrahedra. Borrowed: valid as long as
/// the model.
struct ModelView {
  std::span<const double> surface_positions;        ///< [Ns][3] m
  std::span<const std::int32_t> surface_triangles;  ///< [T][3] counter-clockwise from outside
  std::span<const std::int64_t> surface_mesh_tag;   ///< [Ns] node number in the mesh file
  std::span<const std::int32_t> position_of_node;   ///< [Ns] contact position of a surface node, or -1
  std::span<const std::int32_t> contact_node;       ///< [M] surface node of a contact position
  std::span<const std::uint8_t>
      contact_accessible;  ///< [M] 1: accessible; 0: helper for interpolation beside it
  std::span<const std::int32_t> contact_triangles;  ///< [Tc][3] surface nodes, between contact positions
  std::span<const double> contact_force;         ///< [M][Cf][3] f_alpha d_ref^|alpha|, N; "displacement" only
  std::span<const double> contact_displacement;  ///< [M][C][3] d_alpha, m; "force" and "level" only
  std::span<const double>
      contact_stiffness;  ///< [places][6][4] K_s at rest, N/m, each entry with its gradient
  std::span<const double> contact_domain_radius;  ///< [M] d_max, m, or f_max, N, or t_max
  std::span<const double> contact_series_radius;  ///< [M] of a "displacement" model: r_max, m, at least d_max
  std::span<const double> levels_Z;               ///< [C][L+1] at t = 0, 1/L .. 1; "level" only
  std::size_t level_functions{0};                 ///< C of a "level" model, else 0
  WholeNumbers modes_X;                           ///< [Ns][3][n] dimensionless, over the mode's scale
  std::span<const float> modes_X_scale;           ///< [n]
  WholeNumbers modes_Y;                           ///< [M][C][nY] scaled, over their scale
  std::span<const float> modes_Y_scale;           ///< [M][C] m
  std::span<const std::int64_t> near_offset;      ///< [M+1] prefix sums of the near nodes' counts
  std::span<const std::int32_t> near_node;        ///< [sum K] surface nodes
  WholeNumbers near_field;                        ///< per position [C][K_m][3], windowed, over their scale
  std::span<const float> near_scale;              ///< [M][C] m
  std::span<const std::int32_t> green_node;       ///< [G] surface nodes that carry load; "displacement" only
  WholeNumbers green_Y;                           ///< [G][3][n] amplitudes by load, over their scale
  std::span<const float> green_Y_scale;           ///< [G][3] m/N
  std::span<const std::int64_t> green_offset;     ///< [G+1] prefix sums of the near nodes' counts
  std::span<const std::int32_t> green_near_node;  ///< [sum K] surface nodes
  WholeNumbers green_near;                        ///< [sum K][3 loads][3], windowed, over the load's scale
  std::span<const float> green_near_scale;        ///< [G][3] m/N
  std::span<const std::int64_t> edge_offset;      ///< [E+1] prefix sums of the near nodes' counts, or empty
  std::span<const std::int32_t> edge_node;        ///< [sum K] surface nodes
  WholeNumbers edge_field;                        ///< per edge [Ce][K][3], over their scale
  std::span<const float> edge_scale;              ///< [E][Ce] m
  std::span<const double> mesh_nodes;             ///< [N][3] m
  std::span<const std::int32_t> mesh_tetrahedra;  ///< [V][4]
  std::span<const std::int32_t> mesh_midsides;    ///< [V][6] of quadratic elements, else empty
  std::span<const std::int64_t> mesh_node_tag;    ///< [N]
  std::span<const std::int64_t> mesh_tetrahedron_tag;  ///< [V]
  std::span<const std::int32_t> mesh_fixed;            ///< volume nodes
  std::span<const std::int32_t> mesh_surface_node;     ///< [Ns] volume node of a surface node
  std::span<const std::int32_t> mesh_element_region;   ///< [V] or empty: one material, that of the attributes
  std::span<const RegionName> region_name;             ///< [R] or empty, as the next three
  std::span<const double> region_E;                    ///< [R] Pa
  std::span<const double> region_nu;                   ///< [R]
  std::span<const RegionName> region_law;              ///< [R] of kLaws
  std::span<const std::int32_t> spring_node;           ///< [S] volume nodes, or empty
  std::span<const double> spring_stiffness;  ///< [S] N/m, alike in every direction; stress-free at rest

  [[nodiscard]] std::size_t surfaceNodes() const noexcept { return surface_mesh_tag.size(); }
  [[nodiscard]] std::size_t triangles() const noexcept { return surface_triangles.size() / 3; }
  [[nodiscard]] std::size_t contactTriangles() const noexcept { return contact_triangles.size() / 3; }
  [[nodiscard]] std::size_t positions() const noexcept { return contact_node.size(); }
  /// Contact positions and edges between them, of a "displacement" model.
  [[nodiscard]] std::size_t places() const noexcept { return contact_stiffness.size() / kStiffnessNumbers; }
  [[nodiscard]] std::size_t modes() const noexcept { return modes_X_scale.size(); }
  /// nY, how many modes, the first, contact positions have amplitudes of.
  [[nodiscard]] std::size_t positionModes() const noexcept {
    return modes_Y_scale.empty() ? modes() : modes_Y.size() / modes_Y_scale.size();
  }
};

}  // namespace palpate
