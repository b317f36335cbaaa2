// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/repair/cgal_mesh.h"

#include <cmath>
#include <numeric>

#include "tools/program/printed.h"

namespace palpate::organ {

using mesh::TriangleSurface;

Soup soupOf(const TriangleSurface& surface) {
  Soup soup;
  for (const auto& x : surface.vertices) soup.points.emplace_back(x.x(), x.y(), x.z());
  for (const auto& t : surface.triangles) soup.polygons.emplace_back(t.begin(), t.end());
  return soup;
}

TriangleSurface surfaceOf(const Soup& soup) {
  TriangleSurface surface;
  for (const Point& p : soup.points) surface.vertices.emplace_back(p.x(), p.y(), p.z());
  for (const auto& t : soup.polygons)
    surface.triangles.push_back(
        {static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]), static_cast<std::int32_t>(t[2])});
  surface.vertex_tags.resize(surface.vertices.size());
  surface.triangle_tags.resize(surface.triangles.size());
  std::iota(surface.vertex_tags.begin(), surface.vertex_tags.end(), 1);
  std::iota(surface.triangle_tags.begin(), surface.triangle_tags.end(), 1);
  return surface;
}

TriangleSurface surfaceOf(Mesh& mesh) {
  mesh.collect_garbage();
  Soup soup;
  for (const auto v : mesh.vertices()) soup.points.push_back(mesh.point(v));
  for (const Face f : mesh.faces()) {
    auto& polygon = soup.polygons.emplace_back();
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) polygon.push_back(v);
  }
  return surfaceOf(soup);
}

std::array<double, 3> middleOf(const CGAL::Bbox_3& box) {
  return {(box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2};
}

std::string placeInWords(const CGAL::Bbox_3& box) {
  const std::array<double, 3> x = middleOf(box);
  return program::printed("(%.4g %.4g %.4g) m", x[0], x[1], x[2]);
}

double diagonalOf(const CGAL::Bbox_3& box) {
  return std::hypot(box.x_span(), box.y_span(), box.z_span());
}

}  // namespace palpate::organ
