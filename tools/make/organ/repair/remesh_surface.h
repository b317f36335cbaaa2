// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/triangle_surface.h"

namespace palpate::organ {

/// Gives a repaired surface triangles of one size (CGAL's isotropic remeshing: M. Botsch, L. Kobbelt, "A remeshing
/// approach to multiresolution modeling", SGP 2004), and takes out what then crosses or folds onto itself.
///   Gmsh flattens a surface to remesh it, which the spikes that a repair leaves prevent. Here vertices move on the
/// surface that was there, so edges and corners get as round as the size makes them.
/// @param surface  closed, without surfaceDefects()
/// @param size     length of edges, m; positive
/// @return numbers of vertices and triangles are new, from 1
/// @throw MeshError when defects stay
/// Cost a second for 1e4 triangles. Real-time: no.
[[nodiscard]] mesh::TriangleSurface remeshed(const mesh::TriangleSurface& surface, double size);

}  // namespace palpate::organ
