// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/repair/remesh_surface.h"

#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>

#include "tools/make/organ/repair/mend_crossings.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/surface_defects.h"

namespace palpate::organ {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

constexpr unsigned kIterations = 5, kRelaxations = 3;
constexpr double kLeastFold =
    20;  // degrees; Gmsh takes facets that fold onto each other for overlapping ones

}  // namespace

mesh::TriangleSurface remeshed(const mesh::TriangleSurface& surface, double size) {
  const Soup soup = soupOf(surface);
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, mesh);
  pmp::isotropic_remeshing(
      mesh.faces(), size, mesh,
      pmp::parameters::number_of_iterations(kIterations).number_of_relaxation_steps(kRelaxations));
  (void)mendCrossings(mesh, diagonalOf(pmp::bbox(mesh)), kLeastFold);
  mesh::TriangleSurface even = surfaceOf(mesh);
  const auto defects = mesh::surfaceDefects(even);
  if (!defects.empty())
    throw mesh::MeshError("remeshing the repaired surface leaves defects: " + mesh::inWords(defects));
  return even;
}

}  // namespace palpate::organ
