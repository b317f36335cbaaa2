// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/fill_surface.h"

#include <gmsh.h>

#include <iomanip>
#include <numbers>
#include <sstream>
#include <vector>

#include "tools/mesh/gmsh_session.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/size_field.h"

namespace palpate::mesh {
namespace {

constexpr double kCreaseAngle = 40 * std::numbers::pi / 180;  // sharper edges stay edges when remeshing

void addSurface(const TriangleSurface& surface) {
  std::vector<std::size_t> node_tags, triangle_tags, corners;
  std::vector<double> coordinates;
  for (const auto& x : surface.vertices) {
    coordinates.insert(coordinates.end(), x.data(), x.data() + 3);
    node_tags.push_back(node_tags.size() + 1);
  }
  for (const auto& triangle : surface.triangles) {
    for (const auto vertex : triangle) corners.push_back(static_cast<std::size_t>(vertex) + 1);
    triangle_tags.push_back(triangle_tags.size() + 1);
  }
  gmsh::model::addDiscreteEntity(2, 1);
  gmsh::model::mesh::addNodes(2, 1, node_tags, coordinates);
  gmsh::model::mesh::addElementsByType(1, 2, triangle_tags, corners);
}

void prepareRemeshing(double element_size) {
  gmsh::model::mesh::classifySurfaces(kCreaseAngle, true, true, kCreaseAngle);
  gmsh::model::mesh::createGeometry();
  gmsh::option::setNumber("Mesh.MeshSizeMin", element_size);
  gmsh::option::setNumber("Mesh.MeshSizeMax", element_size);
  gmsh::option::setNumber("Mesh.MeshSizeFromPoints", 0);
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  // Without a field Gmsh takes the sizes of the surface that it replaces.
  std::ostringstream size;
  size << std::setprecision(17) << element_size;
  const int field = gmsh::model::mesh::field::add("MathEval");
  gmsh::model::mesh::field::setString(field, "F", size.str());
  gmsh::model::mesh::field::setAsBackgroundMesh(field);
}

void addVolume() {
  gmsh::vectorpair surfaces;
  gmsh::model::getEntities(surfaces, 2);
  std::vector<int> tags;
  for (const auto& surface : surfaces) tags.push_back(surface.second);
  const int loop = gmsh::model::geo::addSurfaceLoop(tags);
  gmsh::model::geo::addVolume({loop});
  gmsh::model::geo::synchronize();
}

void fillGraded(const ElementSizes& sizes) {
  gmsh::model::mesh::generate(2);
  const InnerSizes inner = innerSizesOfModel(sizes);
  gmsh::model::mesh::field::setAsBackgroundMesh(-1);
  gmsh::option::setNumber("Mesh.MeshSizeMin", 0);
  gmsh::option::setNumber("Mesh.MeshSizeMax", sizes.inner);
  const SizeField field([&](int, int, const Eigen::Vector3d& x) { return inner.at(x); });
  gmsh::model::mesh::generate(3);
}

}  // namespace

TetMesh fillSurface(const TriangleSurface& surface, const ElementSizes& sizes) {
  checkElementSizes(sizes);
  const GmshSession gmsh_session;
  TetMesh mesh;
  gmsh_session.run("the surface cannot be filled with tetrahedra", [&] {
    gmsh::model::add("surface");
    addSurface(surface);
    if (sizes.surface > 0) prepareRemeshing(sizes.surface);
    addVolume();
    gmsh::option::setNumber("Mesh.Optimize", 1);
    sizes.isGraded() ? fillGraded(sizes) : gmsh::model::mesh::generate(3);
    mesh = gmsh_session.tetrahedra();
  });
  if (mesh.tetrahedra.empty())
    throw MeshError("the surface cannot be filled with tetrahedra: Gmsh made none");
  return mesh;
}

}  // namespace palpate::mesh
