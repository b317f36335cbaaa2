// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/liver.h"

#include <gmsh.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tools/make/organ/clamp.h"
#include "tools/make/organ/liver_shape.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/gmsh_session.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/size_field.h"
#include "tools/mesh/topology.h"
#include "tools/program/exit_code.h"

namespace palpate::organ {
namespace {

namespace occ = gmsh::model::occ;
using Vec3 = Eigen::Vector3d;

const Vec3 kBareArea{-0.042, 0.056, 0.014};  // at the back of the right lobe
constexpr double kBareRadius = 0.045;        // m
const Vec3 kInFrontOfNodule{-0.045, -0.090, 0.012};

void checkOptions(const LiverOptions& options) {
  if (!(options.sizes.surface >= 0.003 && options.sizes.surface <= 0.02)) {
    throw program::UsageError("--element-size must be between 0.003 and 0.02 m, not " +
                              std::to_string(options.sizes.surface));
  }
  program::orUsageError([&] { mesh::checkElementSizes(options.sizes); });
  if (options.order != 1 && options.order != 2)
    throw program::UsageError("--element-order must be 1 or 2, not " + std::to_string(options.order));
}

// A smooth solid through all sections. @return its number
int buildBody() {
  std::vector<int> wires;
  for (const LiverSection& section : liverSections()) {
    std::vector<int> points;
    for (const auto& p : section.points) points.push_back(occ::addPoint(section.x, p.x(), p.y()));
    points.push_back(points.front());
    wires.push_back(occ::addWire({occ::addBSpline(points)}));
  }
  gmsh::vectorpair body;
  occ::addThruSections(wires, body, -1, true, false);
  occ::synchronize();
  return std::find_if(body.begin(), body.end(), [](const auto& part) { return part.first == 3; })->second;
}

// Under the point of the surface that is nearest to a point in front of it.
Nodule placeNodule(int body) {
  gmsh::vectorpair faces;
  gmsh::model::getBoundary({{3, body}}, faces, false, false);
  Nodule nodule{};
  for (const auto& face : faces) {
    std::string type;
    gmsh::model::getType(2, face.second, type);
    if (type == "Plane") continue;  // a cap
    std::vector<double> place, parameters;
    gmsh::model::getClosestPoint(2, face.second, {kInFrontOfNodule.begin(), kInFrontOfNodule.end()}, place,
                                 parameters);
    nodule.above = Vec3(place.data());
  }
  nodule.centre = nodule.above + Nodule::kDepth * (nodule.above - kInFrontOfNodule).normalized();
  return nodule;
}

// Parts the body into nodule and liver with one face between them. @return the number of the nodule
int partNodule(int body, const Vec3& centre) {
  const int sphere = occ::addSphere(centre.x(), centre.y(), centre.z(), Nodule::kRadius);
  gmsh::vectorpair parts;
  std::vector<gmsh::vectorpair> parts_of;
  occ::fragment({{3, body}}, {{3, sphere}}, parts, parts_of);
  occ::synchronize();
  const int nodule = parts_of.at(1).at(0).second;
  for (const auto& [dimension, part] : parts) {
    const int group = gmsh::model::addPhysicalGroup(3, {part});
    gmsh::model::setPhysicalName(3, group, part == nodule ? "nodule" : "liver");
  }
  return nodule;
}

void meshSurfaces(const mesh::ElementSizes& sizes, double nodule_size, const Vec3& centre) {
  gmsh::option::setNumber("Mesh.Algorithm", 1);  // MeshAdapt: no slivers along the edge, unlike 5 and 6
  gmsh::option::setNumber("Mesh.MeshSizeFromCurvature", 6);  // a turn of the edge takes six elements
  gmsh::option::setNumber("Mesh.MeshSizeMin", std::min(nodule_size, 0.6 * sizes.surface));
  gmsh::option::setNumber("Mesh.MeshSizeMax", sizes.surface);
  const mesh::SizeField field([&](int, int, const Vec3& x) {
    return nodule_size + sizes.growth * std::max(0.0, (x - centre).norm() - Nodule::kRadius);
  });
  gmsh::model::mesh::generate(2);
}

void meshVolumes(const mesh::ElementSizes& sizes, double nodule_size, int nodule) {
  const mesh::InnerSizes inner = mesh::innerSizesOfModel(sizes);
  gmsh::option::setNumber("Mesh.MeshSizeFromCurvature", 0);
  gmsh::option::setNumber("Mesh.MeshSizeMin", 0);
  gmsh::option::setNumber("Mesh.MeshSizeMax", sizes.inner);
  gmsh::option::setNumber("Mesh.Optimize", 1);
  gmsh::option::setNumber("Mesh.OptimizeThreshold", 0.5);
  const mesh::SizeField field([&](int dimension, int entity, const Vec3& x) {
    return dimension == 3 && entity == nodule ? nodule_size : inner.at(x);
  });
  gmsh::model::mesh::generate(3);
}

std::vector<std::int32_t> bareArea(const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary) {
  std::vector<std::int32_t> fixed;
  std::copy_if(boundary.nodes.begin(), boundary.nodes.end(), std::back_inserter(fixed),
               [&](std::int32_t node) {
                 return (mesh.nodes[static_cast<std::size_t>(node)] - kBareArea).norm() <= kBareRadius;
               });
  return fixed;
}

}  // namespace

Liver makeLiver(const LiverOptions& options) {
  checkOptions(options);
  mesh::ElementSizes sizes = options.sizes;
  if (!sizes.isGraded()) sizes.inner = sizes.surface;
  const double nodule_size = std::min(0.0039, 0.5 * sizes.surface);
  Liver liver;
  const mesh::GmshSession session;
  session.run("the default organ cannot be meshed", [&] {
    gmsh::model::add("liver");
    const int body = buildBody();
    liver.nodule = placeNodule(body);
    const int nodule = partNodule(body, liver.nodule.centre);
    meshSurfaces(sizes, nodule_size, liver.nodule.centre);
    meshVolumes(sizes, nodule_size, nodule);
    liver.mesh = session.tetrahedra();
  });
  mesh::checkMesh(liver.mesh);
  const mesh::BoundarySurface boundary = mesh::boundaryOf(liver.mesh);
  setClamp(liver.mesh, boundary, bareArea(liver.mesh, boundary));
  if (options.order == 2) liver.mesh = mesh::quadraticOf(liver.mesh);
  return liver;
}

}  // namespace palpate::organ
