// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tools/mesh/triangle_surface.h"

namespace palpate::mesh {

/// A closed surface inside a solid's outer one.
struct Cavity {
  double volume;           ///< m^3
  Eigen::Vector3d middle;  ///< of its bounding box, m
};

/// A body that a surface bounds: one closed surface, and those of the cavities in it.
struct Solid {
  TriangleSurface surface;  ///< the outer part faces outward, those of cavities face into the cavity
  double volume{0};         ///< without the cavities, m^3
  Eigen::Vector3d middle;   ///< of the bounding box, m
  std::vector<Cavity> cavities;
};

/// Parts a sound surface into the solids that it bounds, the largest first. A part inside an odd number of others
/// bounds a cavity of the innermost of them, whichever way its triangles face in the file. A surface that bounds one
/// solid
/// keeps the order of its vertices and triangles.
///   Inside is where the winding number, the solid angle that a surface fills over 4 pi, is one: A. Van Oosterom,
///   J. Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Engng 30 (1983) 125-126.
/// @param surface  without surfaceDefects()
/// Cost O(T log T + parts * T). Real-time: no.
[[nodiscard]] std::vector<Solid> solidsOf(const TriangleSurface& surface);

/// Numbers of the parts that hang together by shared vertices: one for each triangle, from 0 in the order of the
/// triangles.
[[nodiscard]] std::vector<std::size_t> partsOf(const TriangleSurface& surface);

}  // namespace palpate::mesh
