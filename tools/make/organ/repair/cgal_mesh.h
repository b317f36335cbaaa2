// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <string>
#include <vector>

#include "tools/mesh/triangle_surface.h"

namespace palpate::organ {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
/// A surface as CGAL changes it. Only the folder repair includes CGAL: its templates take long to compile.
using Mesh = CGAL::Surface_mesh<Point>;
using Face = Mesh::Face_index;
using Halfedge = Mesh::Halfedge_index;

/// Triangles by the indices of their corners.
struct Soup {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
};

[[nodiscard]] Soup soupOf(const mesh::TriangleSurface& surface);
/// Numbers of vertices and triangles from 1.
[[nodiscard]] mesh::TriangleSurface surfaceOf(const Soup& soup);
/// The same, without what was taken away.
[[nodiscard]] mesh::TriangleSurface surfaceOf(Mesh& mesh);

[[nodiscard]] std::array<double, 3> middleOf(const CGAL::Bbox_3& box);
/// "(0.1 0 0) m", its middle.
[[nodiscard]] std::string placeInWords(const CGAL::Bbox_3& box);
[[nodiscard]] double diagonalOf(const CGAL::Bbox_3& box);

}  // namespace palpate::organ
