// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/element_sizes.h"
#include "tools/mesh/tet_mesh.h"

namespace palpate::organ {

/// How the default organ is meshed.
struct LiverOptions {
  mesh::ElementSizes sizes{0.008, 0.020, 0.5};  ///< m; at the surface in [0.003, 0.02]
  int order{2};                                 ///< of the elements, 1 or 2
};

/// Where the default organ's nodule lies.
struct Nodule {
  Eigen::Vector3d centre;
  Eigen::Vector3d above;  ///< the surface point nearest to it
  static constexpr double kRadius = 0.012,
                          kDepth = 0.014;  ///< m, of the sphere; of its centre under the surface
};

/// The default organ and what is in it.
struct Liver {
  mesh::TetMesh mesh;
  Nodule nodule;
};

/// The default organ: a liver of about 0.22 x 0.12 x 0.125 m (liverSections()) with a nodule under the front of its right
/// lobe. x points to the organ's left, y to the back, z up.
///   Groups: `fixed`, the bare area at the back, what of the surface lies within 45 mm of a point of the right lobe;
///   `accessible` (setClamp()). Regions: `nodule`, with elements of at most 5 mm, and `liver`, all others; their common
///   face is one of elements.
/// @throw program::UsageError when a size or the order is out of range, MeshError when Gmsh fails
/// Cost seconds. Threads: one at a time (Gmsh is global state).
[[nodiscard]] Liver makeLiver(const LiverOptions& options = {});

}  // namespace palpate::organ
