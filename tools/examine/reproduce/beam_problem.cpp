// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/beam_problem.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "tools/mesh/box_mesh.h"
#include "tools/mesh/topology.h"

namespace palpate::reproduce {

namespace {

const Eigen::Vector3d kSize(0.4, 0.04, 0.04);  // m
constexpr double kNear = 1e-9;                 // m

std::vector<std::int32_t> clampedNodes(const mesh::TetMesh& mesh) {
  std::vector<std::int32_t> nodes;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (mesh.nodes[i].x() < kNear) nodes.push_back(static_cast<std::int32_t>(i));
  return nodes;
}

solver::PatchSurface surfaceOf(const solver::FeModel& model, const mesh::TetMesh& mesh) {
  mesh::BoundarySurface boundary = mesh::boundaryOf(mesh);
  return {model, std::move(boundary.nodes), std::move(boundary.triangles)};
}

std::vector<std::int32_t> upperNodes(const solver::FeModel& model) {
  std::vector<std::int32_t> nodes;
  for (int i = 0; i < model.nodeCount(); ++i)
    if (model.isFree(i) && model.nodes()[static_cast<std::size_t>(i)].z() > kSize.z() - kNear)
      nodes.push_back(i);
  return nodes;
}

/// A third of every triangle of the upper surface that a node belongs to.
Eigen::VectorXd upperAreas(const solver::PatchSurface& surface, const std::vector<std::int32_t>& nodes) {
  std::vector<double> by_surface_node(surface.nodes.size(), 0.0);
  for (const auto& t : surface.triangles) {
    const auto corner = [&](std::size_t i) { return surface.positions[static_cast<std::size_t>(t[i])]; };
    if (std::min({corner(0).z(), corner(1).z(), corner(2).z()}) < kSize.z() - kNear) continue;
    const double area = 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    for (const std::int32_t node : t) by_surface_node[static_cast<std::size_t>(node)] += area / 3.0;
  }
  Eigen::VectorXd areas(static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto found = std::lower_bound(surface.nodes.begin(), surface.nodes.end(), nodes[i]);
    areas[static_cast<Eigen::Index>(i)] =
        by_surface_node[static_cast<std::size_t>(found - surface.nodes.begin())];
  }
  return areas;
}

solver::SparseMatrix downwardLoads(const solver::FeModel& model, const std::vector<std::int32_t>& nodes,
                                   double load) {
  solver::SparseMatrix loads(model.dofCount(), static_cast<int>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    loads.insert(model.dof(nodes[i]) + 2, static_cast<int>(i)) = -load;
  loads.makeCompressed();
  return loads;
}

int nearestTo(const solver::FeModel& model, const std::vector<std::int32_t>& nodes,
              const Eigen::Vector3d& x) {
  const auto distance = [&](std::int32_t node) {
    return (model.nodes()[static_cast<std::size_t>(node)] - x).squaredNorm();
  };
  const auto found = std::min_element(
      nodes.begin(), nodes.end(), [&](std::int32_t a, std::int32_t b) { return distance(a) < distance(b); });
  return static_cast<int>(found - nodes.begin());
}

}  // namespace

Beam::Beam(const BeamOptions& options)
    : mesh(mesh::makeBox(kSize, options.nodes)),
      model(mesh.nodes, {mesh.tetrahedra}, clampedNodes(mesh), {1e6, 0.25}),
      surface(surfaceOf(model, mesh)),
      nodes(upperNodes(model)),
      problem(model, downwardLoads(model, nodes, options.load), upperAreas(surface, nodes)),
      tip(nearestTo(model, nodes, {kSize.x(), 0.5 * kSize.y(), kSize.z()})) {
  // makeBox: node (i, j, k) is i + nx (j + ny k).
  const auto& n = options.nodes;
  for (int i = 0; i < n[0]; ++i) axis.push_back(i + n[0] * (n[1] / 2 + n[1] * (n[2] / 2)));
}

double Beam::axialStiffness() const {
  return model.material().elasticity.E * kSize.y() * kSize.z();
}

Eigen::VectorXd Beam::toUnknowns(const Eigen::VectorXd& nodal) const {
  Eigen::VectorXd u(model.dofCount());
  for (int node = 0; node < model.nodeCount(); ++node)
    if (model.isFree(node)) u.segment<3>(model.dof(node)) = nodal.segment<3>(3 * node);
  return u;
}

}  // namespace palpate::reproduce
