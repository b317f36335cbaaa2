// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// Size and quality of a mesh. Lengths in m.
struct MeshStatistics {
  std::size_t nodes{0};
  std::size_t corners{0};  ///< nodes that are a corner; all of them in linear meshes
  std::size_t tetrahedra{0};
  std::size_t surface_nodes{0};
  std::size_t surface_corners{0};
  std::size_t surface_triangles{0};  ///< faces of tetrahedra on the boundary
  Eigen::Vector3d box_min{Eigen::Vector3d::Zero()};
  Eigen::Vector3d box_max{Eigen::Vector3d::Zero()};
  double volume{0};                   ///< m^3
  double worst_quality{0};            ///< smallest quality(), in [0, 1]
  std::int64_t worst_tetrahedron{0};  ///< its number in the mesh file
  double mean_edge{0};                ///< over the volume's edges, corner to corner as all edges here
  double median_surface_edge{0};      ///< sets the default patch width, docs/design.md, Symbols
};

/// Shape of a tetrahedron: three times the radius of the inscribed sphere over that of the circumscribed one,
/// 1 for a regular tetrahedron, 0 for a flat one.
[[nodiscard]] double quality(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                             const Eigen::Vector3d& d);

/// @param mesh has passed checkMesh()
/// @param boundary  boundaryOf(mesh)
[[nodiscard]] MeshStatistics statisticsOf(const TetMesh& mesh, const BoundarySurface& boundary);

}  // namespace palpate::mesh
