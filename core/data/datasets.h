// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

/// Where arrays of a model file begin: at multiples of this, bytes.
inline constexpr std::uint64_t kArrayAlignment = 64;

/// UTF-8, zeros behind it.
using RegionName = std::array<char, 64>;
[[nodiscard]] inline std::string textOf(const RegionName& name) {
  return {name.begin(), std::find(name.begin(), name.end(), '\0')};
}
/// Cut where it is longer than a RegionName.
[[nodiscard]] inline RegionName regionName(std::string_view text) {
  RegionName name{};
  text.copy(name.data(), name.size());
  return name;
}

/// One dataset of a model file (docs/model_file.md). T is the type of its numbers.
/// Shape: a length is a number, a symbol that the first dataset with it defines, or one that reader and writer compute
/// ("3 Ns", "Cf"). Row-major; empty entries end the shape.
template <class T>
struct Dataset {
  using Number = T;
  const char* path;  ///< "contact/force"
  std::array<const char*, 4> shape;
  const char* unit;  ///< empty: none

  /// As messages name it: "/contact/force".
  [[nodiscard]] std::string name() const { return std::string("/") + path; }
};

/// All datasets: the only place that spells their paths, types, shapes and units. Ns surface nodes, T triangles, M contact
/// positions, C coefficients of the fields, Cm of those that modes and near fields have (of a "displacement" model without the
/// first degree, which nodal Green's functions give), Cf of the contact's force, G nodes that carry load, P places of the
/// patch's stiffness, E = P - M edges between contact positions, Ce coefficients of these, n modes, of which positions have the
/// first nY, K near nodes of a position,
/// N volume nodes, V tetrahedra, F fixed nodes, R regions, S springs.
namespace dataset {
inline constexpr Dataset<double> kSurfacePositions{"surface/positions", {"Ns", "3"}, "m"};
inline constexpr Dataset<std::int32_t> kSurfaceTriangles{"surface/triangles", {"T", "3"}, ""};
inline constexpr Dataset<std::int64_t> kSurfaceMeshTag{"surface/mesh_tag", {"Ns"}, ""};
inline constexpr Dataset<std::int32_t> kPositionOfNode{"surface/position_of_node", {"Ns"}, ""};

inline constexpr Dataset<std::int32_t> kContactNode{"contact/node", {"M"}, ""};
inline constexpr Dataset<std::uint8_t> kContactAccessible{"contact/accessible", {"M"}, ""};
/// Surface nodes of the triangles between contact positions: those of the surface, or of each four of these (quadratic faces).
inline constexpr Dataset<std::int32_t> kContactTriangles{"contact/triangles", {"Tc", "3"}, ""};
inline constexpr Dataset<double> kContactDomainRadius{"contact/domain_radius", {"M"}, "m, N or none"};
inline constexpr Dataset<double> kContactSeriesRadius{"contact/series_radius", {"M"}, "m"};
/// "displacement" models only.
inline constexpr Dataset<double> kContactForce{"contact/force", {"M", "Cf", "3"}, "N"};
/// "displacement" models only: xx xy xz yy yz zz of K_s, each with its gradient over the surface, at SmoothPlaces.
inline constexpr Dataset<double> kContactStiffness{"contact/stiffness", {"P", "6", "4"}, "N/m, N/m^2"};
/// "force" and "level" models only.
inline constexpr Dataset<double> kContactDisplacement{"contact/displacement", {"M", "C", "3"}, "m"};
/// "level" models only.
inline constexpr Dataset<double> kLevelsZ{"levels/Z", {"C", "L + 1"}, ""};

// Fields are whole numbers; a number is its block's scale times these, and has the scale's unit.
inline constexpr Dataset<std::int16_t> kModesX{"modes/X", {"3 Ns", "n"}, ""};
inline constexpr Dataset<float> kModesXScale{"modes/X_scale", {"n"}, ""};
inline constexpr Dataset<std::int16_t> kModesY{"modes/Y", {"M", "Cm", "nY"}, ""};
inline constexpr Dataset<float> kModesYScale{"modes/Y_scale", {"M", "Cm"}, "m"};

inline constexpr Dataset<std::int64_t> kNearOffset{"near/offset", {"M + 1"}, ""};
inline constexpr Dataset<std::int32_t> kNearNode{"near/node", {"sum K"}, ""};
inline constexpr Dataset<std::int16_t> kNearField{"near/field", {"3 Cm sum K"}, ""};
inline constexpr Dataset<float> kNearScale{"near/scale", {"M", "Cm"}, "m"};

// Nodal Green's functions, of "displacement" models only: amplitudes of the modes and near field by unit loads.
inline constexpr Dataset<std::int32_t> kGreenNode{"green/node", {"G"}, ""};
inline constexpr Dataset<std::int16_t> kGreenY{"green/Y", {"G", "3", "n"}, ""};
inline constexpr Dataset<float> kGreenYScale{"green/Y_scale", {"G", "3"}, "m/N"};
inline constexpr Dataset<std::int64_t> kGreenOffset{"green/offset", {"G + 1"}, ""};
inline constexpr Dataset<std::int32_t> kGreenNearNode{"green/near_node", {"sum Kg"}, ""};
inline constexpr Dataset<std::int16_t> kGreenNear{"green/near", {"sum Kg", "9"}, ""};
inline constexpr Dataset<float> kGreenNearScale{"green/near_scale", {"G", "3"}, "m/N"};

// What the middles of the edges between contact positions add to the mixture of these, orders of two and more of a
// "displacement" model. All four, or none.
inline constexpr Dataset<std::int64_t> kEdgeOffset{"edges/offset", {"E + 1"}, ""};
inline constexpr Dataset<std::int32_t> kEdgeNode{"edges/node", {"sum Ke"}, ""};
inline constexpr Dataset<std::int16_t> kEdgeField{"edges/field", {"3 Ce sum Ke"}, ""};
inline constexpr Dataset<float> kEdgeScale{"edges/scale", {"E", "Ce"}, "m"};

inline constexpr Dataset<double> kMeshNodes{"mesh/nodes", {"N", "3"}, "m"};
inline constexpr Dataset<std::int32_t> kMeshTetrahedra{"mesh/tetrahedra", {"V", "4"}, ""};
/// Of quadratic elements: nodes in the middle of the edges 01, 12, 02, 03, 13, 23. Optional.
inline constexpr Dataset<std::int32_t> kMeshMidsides{"mesh/midsides", {"V", "6"}, ""};
inline constexpr Dataset<std::int64_t> kMeshNodeTag{"mesh/node_tag", {"N"}, ""};
inline constexpr Dataset<std::int64_t> kMeshTetrahedronTag{"mesh/tetrahedron_tag", {"V"}, ""};
inline constexpr Dataset<std::int32_t> kMeshFixed{"mesh/fixed", {"F"}, ""};
inline constexpr Dataset<std::int32_t> kMeshSurfaceNode{"mesh/surface_node", {"Ns"}, ""};

// Regions of another material than the attributes': all five, or none.
inline constexpr Dataset<std::int32_t> kElementRegion{"mesh/element_region", {"V"}, ""};
inline constexpr Dataset<RegionName> kRegionName{"regions/name", {"R"}, ""};
inline constexpr Dataset<double> kRegionE{"regions/E", {"R"}, "Pa"};
inline constexpr Dataset<double> kRegionNu{"regions/nu", {"R"}, ""};
inline constexpr Dataset<RegionName> kRegionLaw{"regions/law", {"R"}, ""};

// Springs between nodes and their rest positions: both, or none.
inline constexpr Dataset<std::int32_t> kSpringNode{"springs/node", {"S"}, ""};
inline constexpr Dataset<double> kSpringStiffness{"springs/stiffness", {"S"}, "N/m"};
}  // namespace dataset

}  // namespace palpate
