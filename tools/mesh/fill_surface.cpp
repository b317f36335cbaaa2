// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/fill_surface.h"

#include <gmsh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <iomanip>
#include <numbers>
#include <set>
#include <sstream>
#include <vector>

#include "tools/mesh/gmsh_session.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/size_field.h"
#include "tools/mesh/surface_solids.h"

namespace palpate::mesh {
namespace {

constexpr double kCreaseAngle = 40 * std::numbers::pi / 180;  // sharper edges stay edges when remeshing

// One discrete surface for each part: the outer one, then those of cavities. Vertices belong to the part that uses
// them.
void addSurface(const TriangleSurface& surface) {
  const std::vector<std::size_t> parts = partsOf(surface);
  const std::size_t count = *std::max_element(parts.begin(), parts.end()) + 1;
  std::vector<std::size_t> part_of(surface.vertices.size(), 0);
  std::vector<std::vector<std::size_t>> node_tags(count), triangle_tags(count), corners(count);
  std::vector<std::vector<double>> coordinates(count);
  for (std::size_t t = 0; t < parts.size(); ++t) {
    triangle_tags[parts[t]].push_back(t + 1);
    for (const auto vertex : surface.triangles[t]) {
      part_of[static_cast<std::size_t>(vertex)] = parts[t];
      corners[parts[t]].push_back(static_cast<std::size_t>(vertex) + 1);
    }
  }
  for (std::size_t v = 0; v < part_of.size(); ++v) {
    const Eigen::Vector3d& x = surface.vertices[v];
    node_tags[part_of[v]].push_back(v + 1);
    coordinates[part_of[v]].insert(coordinates[part_of[v]].end(), x.data(), x.data() + 3);
  }
  for (std::size_t part = 0; part < count; ++part) {
    const int entity = gmsh::model::addDiscreteEntity(2);
    gmsh::model::mesh::addNodes(2, entity, node_tags[part], coordinates[part]);
    gmsh::model::mesh::addElementsByType(entity, 2, triangle_tags[part], corners[part]);
  }
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

// Surfaces that share curves close one part; remeshing divides a part into several.
std::vector<std::vector<int>> closedParts() {
  gmsh::vectorpair surfaces;
  gmsh::model::getEntities(surfaces, 2);
  std::vector<std::vector<int>> parts;
  std::vector<std::set<int>> curves_of;
  for (const auto& surface : surfaces) {
    gmsh::vectorpair curves;
    gmsh::model::getBoundary({surface}, curves, false, false);
    std::vector<int> tags{surface.second};
    std::set<int> own;
    for (const auto& curve : curves) own.insert(curve.second);
    for (std::size_t i = parts.size(); i-- > 0;) {
      const bool apart =
          std::none_of(own.begin(), own.end(), [&](int c) { return curves_of[i].contains(c); });
      if (apart) continue;
      tags.insert(tags.begin(), parts[i].begin(), parts[i].end());
      own.insert(curves_of[i].begin(), curves_of[i].end());
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
      curves_of.erase(curves_of.begin() + static_cast<std::ptrdiff_t>(i));
    }
    parts.push_back(std::move(tags));
    curves_of.push_back(std::move(own));
  }
  return parts;
}

double boxVolume(const std::vector<int>& surfaces) {
  Eigen::AlignedBox3d box;
  for (const int tag : surfaces) {
    Eigen::Vector3d low, high;
    gmsh::model::getBoundingBox(2, tag, low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
    box.extend(low).extend(high);
  }
  return box.volume();
}

// The first loop bounds the volume from outside, the others its cavities.
void addVolume() {
  std::vector<std::vector<int>> parts = closedParts();
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return boxVolume(a) > boxVolume(b); });
  std::vector<int> loops;
  for (const auto& part : parts) loops.push_back(gmsh::model::geo::addSurfaceLoop(part));
  gmsh::model::geo::addVolume(loops);
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
