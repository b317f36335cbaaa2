// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/make/organ/repair/repairs.h"
#include "tools/mesh/triangle_surface.h"

namespace palpate::organ {

/// The rim of a hole that is filled spans at most this part of the body's diagonal.
constexpr double kLargestHole = 0.25;
/// Makes a scanned surface one that bounds a solid, by CGAL's polygon mesh processing: leaves out triangles that are
/// not finite, flat or there twice; merges vertices nearer than kMergeDistance; turns parts over until all face the
/// same way,
/// outward; stitches edges that lie side by side; leaves out loose pieces; takes away triangles that cross, with those
/// around them; and fills holes by patches that continue the surface around them smoothly.
///   Sound parts keep the coordinates of their vertices. Numbers of vertices and triangles are new, from 1.
/// @param[out] repairs  what changed
/// @throw MeshError when a hole is larger than kLargestHole, with its place and size, or something cannot be repaired
/// Cost seconds for 1e5 triangles. Real-time: no.
[[nodiscard]] mesh::TriangleSurface repairSurface(const mesh::TriangleSurface& surface, Repairs& repairs);

}  // namespace palpate::organ
