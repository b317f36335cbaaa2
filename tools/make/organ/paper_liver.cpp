// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/paper_liver.h"

#include <gmsh.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <queue>
#include <utility>
#include <vector>

#include "tools/make/organ/clamp.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/gmsh_session.h"
#include "tools/mesh/topology.h"
#include "tools/program/exit_code.h"

namespace palpate::organ {
namespace {

namespace occ = gmsh::model::occ;
constexpr double kRounding = 0.020;      // radius of the rounded creases, m; OpenCASCADE gives up at 0.022
constexpr double kFixedFraction = 0.10;  // of the surface nodes

struct Ellipsoid {
  Eigen::Vector3d centre, radii;
  double turn;  // about y, rad
};
const Ellipsoid kRightLobe{{-0.033, 0, 0}, {0.074, 0.065, 0.069}, 0};
const Ellipsoid kLeftLobe{{0.038, 0.006, 0.0134}, {0.081, 0.046, 0.046}, -0.15};
const Ellipsoid kHollow{{0.0285, -0.015, -0.074}, {0.1235, 0.060, 0.056}, 0};  // the visceral face

gmsh::vectorpair addEllipsoid(const Ellipsoid& e) {
  gmsh::vectorpair body{{3, occ::addSphere(0, 0, 0, 1)}};
  // Poles along x: where they meet the creases, tiny faces would force slivers into the mesh.
  occ::rotate(body, 0, 0, 0, 0, 1, 0, std::numbers::pi / 2);
  occ::dilate(body, 0, 0, 0, e.radii.x(), e.radii.y(), e.radii.z());
  occ::rotate(body, 0, 0, 0, 0, 1, 0, e.turn);
  occ::translate(body, e.centre.x(), e.centre.y(), e.centre.z());
  return body;
}

// The edges between two different faces; the seams of the spheres lie within one.
std::vector<int> creases(int volume) {
  std::vector<int> found;
  gmsh::vectorpair faces, curves;
  gmsh::model::getBoundary({{3, volume}}, faces, false, false);
  gmsh::model::getBoundary(faces, curves, false, false);
  std::sort(curves.begin(), curves.end());
  curves.erase(std::unique(curves.begin(), curves.end()), curves.end());
  for (const auto& curve : curves) {
    std::vector<int> upward, downward;
    gmsh::model::getAdjacencies(1, curve.second, upward, downward);
    if (upward.size() > 1) found.push_back(curve.second);
  }
  return found;
}

void buildBody() {
  gmsh::vectorpair body;
  std::vector<gmsh::vectorpair> origins;
  occ::fuse(addEllipsoid(kRightLobe), addEllipsoid(kLeftLobe), body, origins);
  gmsh::vectorpair cut;
  occ::cut(body, addEllipsoid(kHollow), cut, origins);
  occ::synchronize();
  const int volume = cut.at(0).second;
  gmsh::vectorpair rounded;
  occ::fillet({volume}, creases(volume), {kRounding}, rounded);
  occ::synchronize();
}

void meshBody(double element_size) {
  gmsh::option::setNumber("Mesh.MeshSizeMin", element_size);
  gmsh::option::setNumber("Mesh.MeshSizeMax", element_size);
  gmsh::option::setNumber("Mesh.Algorithm", 6);  // Frontal-Delaunay: the most regular triangles
  gmsh::option::setNumber("Mesh.Optimize", 1);
  gmsh::model::mesh::generate(3);
}

// Surface nodes in order of their distance from `start` along the edges of the surface.
std::vector<std::int32_t> byDistance(const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary,
                                     std::size_t start) {
  const std::size_t count = boundary.nodes.size();
  const auto at = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(boundary.nodes[i])]; };
  std::vector<std::vector<std::size_t>> neighbours(count);
  for (const auto& t : boundary.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      neighbours[static_cast<std::size_t>(t[i])].push_back(static_cast<std::size_t>(t[(i + 1) % 3]));
    }
  }
  std::vector<bool> done(count, false);
  std::vector<std::int32_t> order;
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [distance, i] = open.top();
    open.pop();
    if (done[i]) continue;
    done[i] = true;
    order.push_back(boundary.nodes[i]);
    for (const auto j : neighbours[i]) open.emplace(distance + (at(i) - at(j)).norm(), j);
  }
  return order;
}

void addGroups(mesh::TetMesh& mesh) {
  const mesh::BoundarySurface boundary = mesh::boundaryOf(mesh);
  std::size_t rearmost = 0;
  const auto y = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(boundary.nodes[i])].y(); };
  for (std::size_t i = 1; i < boundary.nodes.size(); ++i) {
    if (y(i) > y(rearmost)) rearmost = i;
  }
  std::vector<std::int32_t> fixed = byDistance(mesh, boundary, rearmost);
  fixed.resize(static_cast<std::size_t>(kFixedFraction * static_cast<double>(fixed.size())));
  setClamp(mesh, boundary, std::move(fixed));
}

}  // namespace

mesh::TetMesh makePaperLiver(double element_size) {
  if (!(element_size >= 0.003 && element_size <= 0.02)) {
    throw program::UsageError("--element-size must be between 0.003 and 0.02 m, not " +
                              std::to_string(element_size));
  }
  const mesh::GmshSession session;
  mesh::TetMesh mesh;
  session.run("the paper's organ cannot be meshed", [&] {
    gmsh::model::add("paper-liver");
    buildBody();
    meshBody(element_size);
    mesh = session.tetrahedra();
  });
  mesh::checkMesh(mesh);
  addGroups(mesh);
  return mesh;
}

}  // namespace palpate::organ
