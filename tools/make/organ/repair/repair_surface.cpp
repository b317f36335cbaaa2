// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/repair/repair_surface.h"

#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>

#include <algorithm>

#include "tools/make/organ/repair/mend_crossings.h"
#include "tools/make/organ/repair/soup.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/surface_defects.h"
#include "tools/mesh/surface_solids.h"

namespace palpate::organ {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using mesh::TriangleSurface;

// A part faces outward where it encloses a positive volume.
void turnPartsOutward(Soup& soup) {
  const TriangleSurface surface = surfaceOf(soup);
  const std::vector<std::size_t> part = mesh::partsOf(surface);
  std::vector<TriangleSurface> parts(*std::max_element(part.begin(), part.end()) + 1);
  for (std::size_t t = 0; t < part.size(); ++t) {
    TriangleSurface& own = parts[part[t]];
    const auto first = static_cast<std::int32_t>(own.vertices.size());
    for (const auto v : surface.triangles[t])
      own.vertices.push_back(surface.vertices[static_cast<std::size_t>(v)]);
    own.triangles.push_back({first, first + 1, first + 2});
  }
  for (std::size_t t = 0; t < part.size(); ++t)
    if (mesh::enclosedVolume(parts[part[t]]) < 0) std::swap(soup.polygons[t][1], soup.polygons[t][2]);
}

std::size_t turnedOver(const Soup& before, const Soup& after) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < before.polygons.size(); ++t) {
    const Point& first = before.points[before.polygons[t][0]];
    const auto& now = after.polygons[t];
    std::size_t k = 0;
    while (k < 2 && after.points[now[k]] != first) ++k;
    count += after.points[now[(k + 1) % 3]] != before.points[before.polygons[t][1]];
  }
  return count;
}

Mesh orientedMesh(const TriangleSurface& surface, Repairs& repairs) {
  const Soup file = soupOf(surface);
  Soup soup = file;
  pmp::orient_polygon_soup(soup.points, soup.polygons);  // parts edges in more than two triangles, too
  turnPartsOutward(soup);
  repairs.turned_over = turnedOver(file, soup);
  repairs.volume_before = mesh::enclosedVolume(surfaceOf(soup));
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, mesh);
  return mesh;
}

}  // namespace

TriangleSurface repairSurface(const TriangleSurface& surface, Repairs& repairs) {
  repairs = {};
  const TriangleSurface clean = cleaned(surface, repairs);
  repairs.volume_of_file = mesh::enclosedVolume(clean);
  repairs.crossing_pairs = mesh::selfIntersections(clean).size();
  Mesh mesh = orientedMesh(clean, repairs);
  const double diagonal = diagonalOf(pmp::bbox(mesh));
  // Loose pieces hang on edges in three triangles: without them, the other two become one edge again.
  repairs.stitched = pmp::stitch_borders(mesh);
  repairs.loose = leaveOutLoosePieces(mesh);
  repairs.stitched += pmp::stitch_borders(mesh);
  pmp::duplicate_non_manifold_vertices(mesh);
  repairs.flat += mendFlatTriangles(mesh);
  repairs.holes = fillHoles(mesh, diagonal, kLargestHole, repairs.fills);
  const Mended mended = mendCrossings(mesh, diagonal);
  repairs.crossing_removed = mended.removed;
  repairs.fills += mended.fills;
  TriangleSurface whole = surfaceOf(mesh);
  if (whole.triangles.empty()) throw mesh::MeshError("the repair leaves nothing of the surface");
  repairs.volume_after = mesh::enclosedVolume(whole);
  const auto defects = mesh::surfaceDefects(whole);
  if (!defects.empty()) throw mesh::MeshError("the repair leaves defects: " + mesh::inWords(defects));
  return whole;
}

}  // namespace palpate::organ
