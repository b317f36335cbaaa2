// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/fine_part.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/index.h"
#include "tools/mesh/eighths.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/topology.h"
#include "tools/solver/fem/cholesky.h"

namespace palpate::solver {

namespace {

using Barycentric = Eigen::Vector4d;

constexpr double kOn = 1e-9;  // barycentric weight of a node that is on a face

/// Shape functions of an element of 4 or 10 nodes.
double shape(std::size_t nodes, std::size_t a, const Barycentric& L) {
  const auto of = [&](int i) { return L[i]; };
  if (a >= 4) return 4.0 * of(mesh::kTetEdges[a - 4][0]) * of(mesh::kTetEdges[a - 4][1]);
  const double l = of(static_cast<int>(a));
  return nodes == 4 ? l : l * (2.0 * l - 1.0);
}

/// Faces of the chosen elements that lie within the organ.
std::set<std::array<std::int32_t, 3>> cutFaces(const mesh::TetMesh& mesh,
                                               std::span<const std::int32_t> chosen) {
  mesh::TetMesh part;
  for (const std::int32_t t : chosen) part.tetrahedra.push_back(mesh.tetrahedra[index(t)]);
  std::set<std::array<std::int32_t, 3>> cut, outer;
  const auto alone = [](const mesh::TetMesh& of, std::set<std::array<std::int32_t, 3>>& into) {
    for (const mesh::TetFace& face : mesh::sortedFaces(of))
      if (const auto [place, is_new] = into.insert(face.key); !is_new) into.erase(place);
  };
  alone(part, cut);
  alone(mesh, outer);
  for (const auto& face : outer) cut.erase(face);
  return cut;
}

}  // namespace

std::array<Vec3, 3> cornersOf(const PatchSurface& surface, std::size_t face) {
  const auto& t = surface.faces[face];
  return {surface.positions[index(t[0])], surface.positions[index(t[1])], surface.positions[index(t[2])]};
}

/// Unknowns to nodes.
Columns nodal(const FeModel& model, const Eigen::MatrixXd& unknowns) {
  Columns u = Columns::Zero(3 * model.nodeCount(), 3);
  for (int node = 0; node < model.nodeCount(); ++node)
    if (model.isFree(node)) u.middleRows<3>(3 * node) = unknowns.middleRows<3>(model.dof(node));
  return u;
}

/// G_s: unit loads on a patch.
Eigen::MatrixXd loads(const FeModel& model, const Patch& patch) {
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(model.dofCount(), 3);
  for (std::size_t i = 0; i < patch.nodes.size(); ++i)
    for (int c = 0; c < 3; ++c) G(model.dof(patch.nodes[i]) + c, c) = patch.weights[i];
  return G;
}

/// n . K_s n, N/m, of the fields of unit loads.
double stiffnessOf(const Patch& patch, const Columns& u, const Vec3& n) {
  Mat3 C = Mat3::Zero();
  for (std::size_t i = 0; i < patch.nodes.size(); ++i)
    C += patch.weights[i] * u.middleRows<3>(3 * patch.nodes[i]);
  return n.dot((0.5 * (C + C.transpose())).inverse() * n);
}

/// The point of a face that is nearest to x in its plane.
ContactPoint pointAt(const PatchSurface& surface, const Vec3& x) {
  ContactPoint best;
  double farthest = 0.0;  // barycentric weight that is least, of the best face so far
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const auto [a, b, c] = cornersOf(surface, f);
    const Vec3 n = (b - a).cross(c - a);
    const std::array<double, 3> l{(c - b).cross(x - b).dot(n) / n.squaredNorm(),
                                  (a - c).cross(x - c).dot(n) / n.squaredNorm(),
                                  (b - a).cross(x - a).dot(n) / n.squaredNorm()};
    const double off = std::abs((x - a).dot(n)) / std::pow(n.norm(), 1.5);
    const double least = std::min({l[0], l[1], l[2]}) - 10.0 * off;
    if (best.triangle >= 0 && least <= farthest) continue;
    farthest = least;
    best = {static_cast<std::int32_t>(f), l};
  }
  double sum = 0.0;
  for (double& l : best.barycentric) sum += l = std::max(l, 0.0);
  for (double& l : best.barycentric) l /= sum;
  return best;
}

PatchSurface surfaceOf(const FeModel& model, const mesh::TetMesh& mesh) {
  mesh::BoundarySurface boundary = mesh::boundaryOf(mesh);
  return {model, std::move(boundary.nodes), std::move(boundary.triangles), std::move(boundary.faces)};
}

std::vector<std::int32_t> elementsNear(const mesh::TetMesh& mesh, const Vec3& x, double reach) {
  std::vector<std::int32_t> chosen;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& corners = mesh.tetrahedra[t];
    if (std::any_of(corners.begin(), corners.end(),
                    [&](std::int32_t node) { return (mesh.nodes[index(node)] - x).norm() < reach; }))
      chosen.push_back(static_cast<std::int32_t>(t));
  }
  return chosen;
}

FinePart::FinePart(const SolverSetup& setup, const mesh::TetMesh& mesh, const Columns& coarse,
                   std::span<const std::int32_t> chosen) {
  mesh::Eighths eighths = mesh::eighthsOf(mesh, chosen);
  parent_ = std::move(eighths.parent);
  mesh_ = mesh.isQuadratic() ? mesh::quadraticOf(eighths.mesh) : std::move(eighths.mesh);
  material_ = setup.model.material();
  if (!material_.regions.empty()) {
    material_.region_of_element.clear();
    for (const std::int32_t t : parent_)
      material_.region_of_element.push_back(setup.model.material().region_of_element[index(t)]);
  }
  follow(setup, mesh, coarse, cutFaces(mesh, chosen));
}

void FinePart::follow(const SolverSetup& setup, const mesh::TetMesh& mesh, const Columns& coarse,
                      const std::set<std::array<std::int32_t, 3>>& cut) {
  given_ = Columns::Zero(3 * static_cast<Eigen::Index>(mesh_.nodes.size()), 3);
  std::vector<bool> held(mesh_.nodes.size(), false);
  for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
    const auto& corners = mesh.tetrahedra[index(parent_[t])];
    Mat3 edges;
    for (std::size_t k = 0; k < 3; ++k)
      edges.col(Eigen::Index(k)) = mesh.nodes[index(corners[k + 1])] - mesh.nodes[index(corners[0])];
    const Mat3 inverse = edges.inverse();
    std::array<bool, 4> is_cut{};
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<std::int32_t, 3> key{};
      for (std::size_t j = 0; j < 3; ++j) key[j] = corners[(k + 1 + j) % 4];
      std::sort(key.begin(), key.end());
      is_cut[k] = cut.count(key) != 0;
    }
    std::vector<std::int32_t> own(mesh_.tetrahedra[t].begin(), mesh_.tetrahedra[t].end());
    if (mesh_.isQuadratic()) own.insert(own.end(), mesh_.midsides[t].begin(), mesh_.midsides[t].end());
    const std::span<const std::int32_t> from = setup.model.elementNodes(parent_[t]);
    for (const std::int32_t node : own) {
      const Vec3 l = inverse * (mesh_.nodes[index(node)] - mesh.nodes[index(corners[0])]);
      const Barycentric L(1.0 - l.sum(), l[0], l[1], l[2]);
      bool clamped = true, at_cut = false;
      for (std::size_t k = 0; k < 4; ++k) {
        const bool on = std::abs(L[Eigen::Index(k)]) < kOn;
        at_cut = at_cut || (on && is_cut[k]);
        clamped = clamped && (on || !setup.model.isFree(corners[k]));
      }
      if (!at_cut && !clamped) continue;
      held[index(node)] = true;
      auto u = given_.middleRows<3>(3 * node);
      u.setZero();
      for (std::size_t a = 0; a < from.size(); ++a)
        u += shape(from.size(), a, L) * coarse.middleRows<3>(3 * from[a]);
    }
  }
  for (std::size_t node = 0; node < held.size(); ++node)
    if (held[node]) held_.push_back(static_cast<std::int32_t>(node));
}

double FinePart::stiffnessAt(const Vec3& x, const Vec3& n, double patch_radius) const {
  const FeModel model(mesh_.nodes, {mesh_.tetrahedra, mesh_.midsides}, held_, material_);
  const PatchSurface surface = surfaceOf(model, mesh_);
  const Patch patch = makePatch(model, surface, pointAt(surface, x), patch_radius);
  Eigen::MatrixXd b = loads(model, patch);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(3 * model.nodeCount());
  for (int e = 0; e < model.elementCount(); ++e) {
    const std::span<const std::int32_t> nodes = model.elementNodes(e);
    if (std::all_of(nodes.begin(), nodes.end(), [&](std::int32_t node) { return model.isFree(node); }))
      continue;
    Columns u(3 * static_cast<Eigen::Index>(nodes.size()), 3);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      u.middleRows<3>(3 * Eigen::Index(a)) = given_.middleRows<3>(3 * nodes[a]);
    const Columns f = model.elementTangent(e, rest) * u;
    for (std::size_t a = 0; a < nodes.size(); ++a)
      if (model.isFree(nodes[a]))
        b.middleRows<3>(model.dof(nodes[a])) -= f.middleRows<3>(3 * Eigen::Index(a));
  }
  Cholesky factor(model);
  factor.factorize(rest);
  return stiffnessOf(patch, nodal(model, factor.solve(b)), n);
}

}  // namespace palpate::solver
