// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/synthetic_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/multi_index.h"
#include "core/data/model_view.h"
#include "core/surface/contact_patches.h"
#include "core/surface/smooth_places.h"
#include "core/surface/surface_distance.h"
#include "tools/examine/bench/ellipsoid.h"
#include "tools/examine/bench/synthetic_fields.h"

namespace palpate::bench {

namespace {

using modelfile::ModelData;

const Vec3 kSemiAxes(0.085, 0.075, 0.070);  // m; the default organ's surface is as large
constexpr double kStiffness = 500.0;        // N/m
constexpr double kReference = 0.004;        // d_ref, m
constexpr double kDomain = 0.0065;          // d_max, m
constexpr int kOrder = 3, kForceOrder = 6;

/// Distance between neighbours, m, for nodes that share the area in a triangular grid.
double edgeOf(const Ellipsoid& surface) {
  double area = 0.0;
  for (const auto& [a, b, c] : surface.triangles) {
    const auto X = [&](std::int32_t i) -> const Vec3& { return surface.nodes[static_cast<std::size_t>(i)]; };
    area += 0.5 * (X(b) - X(a)).cross(X(c) - X(a)).norm();
  }
  return std::sqrt(2.0 / std::sqrt(3.0) * area / static_cast<double>(surface.nodes.size()));
}

void fillSurface(const Ellipsoid& surface, ModelData& data) {
  for (const Vec3& X : surface.nodes) {
    data.surface_positions.insert(data.surface_positions.end(), {X.x(), X.y(), X.z()});
    const auto node = static_cast<std::int32_t>(data.surface_mesh_tag.size());
    data.surface_mesh_tag.push_back(node + 1);
    data.mesh_surface_node.push_back(node);
    if (X.z() < -0.8 * kSemiAxes.z()) data.mesh_fixed.push_back(node);  // a tenth, as of the default organ
  }
  for (const auto& triangle : surface.triangles)
    data.surface_triangles.insert(data.surface_triangles.end(), triangle.begin(), triangle.end());
}

/// Tetrahedra from the surface to the centre.
void fillMesh(const Ellipsoid& surface, ModelData& data) {
  const auto centre = static_cast<std::int32_t>(surface.nodes.size());
  data.mesh_nodes = data.surface_positions;
  data.mesh_nodes.insert(data.mesh_nodes.end(), {0.0, 0.0, 0.0});
  data.mesh_node_tag = data.surface_mesh_tag;
  data.mesh_node_tag.push_back(centre + 1);
  for (const auto& [a, b, c] : surface.triangles) {
    data.mesh_tetrahedra.insert(data.mesh_tetrahedra.end(), {centre, a, b, c});
    data.mesh_tetrahedron_tag.push_back(static_cast<std::int64_t>(data.mesh_tetrahedron_tag.size()) + 1);
  }
}

/// The free nodes nearest to the top.
void fillPositions(const Ellipsoid& surface, int positions, ModelData& data) {
  std::vector<std::int32_t> nearest(surface.nodes.size());
  std::iota(nearest.begin(), nearest.end(), 0);
  const auto distance = [&](std::int32_t i) {
    return (surface.nodes[static_cast<std::size_t>(i)] - surface.nodes.front()).norm();
  };
  std::sort(nearest.begin(), nearest.end(),
            [&](std::int32_t a, std::int32_t b) { return distance(a) < distance(b); });
  const std::size_t most = surface.nodes.size() - data.mesh_fixed.size();  // the bottom is farthest
  nearest.resize(std::min(static_cast<std::size_t>(positions), most));
  data.position_of_node.assign(surface.nodes.size(), -1);
  for (const std::int32_t node : nearest) {
    data.position_of_node[static_cast<std::size_t>(node)] =
        static_cast<std::int32_t>(data.contact_node.size());
    data.contact_node.push_back(node);
    data.contact_accessible.push_back(1);
    data.contact_domain_radius.push_back(kDomain);
    data.contact_series_radius.push_back(kDomain);
  }
}

/// Coefficient of x^beta, x = d / d_ref, in an energy, J: k/2 |d|^2, and small terms that vary with the
/// place.
double energyCoefficient(const Vec3& X, const MultiIndex& beta) {
  const double scale = kStiffness * kReference * kReference;
  const int degree = beta[0] + beta[1] + beta[2];
  if (degree < 2) return 0.0;
  if (degree == 2) return beta[0] == 2 || beta[1] == 2 || beta[2] == 2 ? 0.5 * scale : 0.0;
  const double phase = 30.0 * X.x() * beta[0] + 20.0 * X.y() * beta[1] + 10.0 * X.z() * beta[2] + degree;
  return 0.05 * scale * std::sin(phase) / (degree * degree);
}

/// f_i = dW/dd_i: the coefficient of x^alpha is (alpha_i + 1) w_{alpha + e_i} / d_ref.
void fillContact(const Ellipsoid& surface, ModelData& data) {
  const MonomialBasis basis(kForceOrder);
  for (const std::int32_t node : data.contact_node)
    for (int k = 0; k < basis.size(); ++k)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        MultiIndex beta = basis[k];
        ++beta[axis];
        const Vec3& X = surface.nodes[static_cast<std::size_t>(node)];
        data.contact_force.push_back(beta[axis] * energyCoefficient(X, beta) / kReference);
      }
}

/// As stiff everywhere.
void fillStiffness(ModelData& data) {
  const SmoothPlaces places(data.surface_positions, data.surface_triangles, data.position_of_node);
  data.contact_stiffness.assign(places.size() * kStiffnessNumbers, 0.0);
  for (std::size_t i = 0; i < data.contact_stiffness.size(); i += kStiffnessNumbers)
    for (const std::size_t diagonal : {0U, 12U, 20U}) data.contact_stiffness[i + diagonal] = kStiffness;
}

/// The contact positions, and what else patches in their triangles load.
void fillLoaded(ModelData& data) {
  std::vector<std::uint8_t> free(data.surface_mesh_tag.size(), 1), near(free.size(), 0);
  for (const std::int32_t node : data.mesh_fixed) free[static_cast<std::size_t>(node)] = 0;
  const SurfaceGraph graph(data.surface_positions, data.surface_triangles);
  const ContactPatches patches(graph, free, data.attributes.patch_radius, data.contact_node);
  for (const std::int32_t node : data.contact_node) patches.markNear(node, near);
  for (const std::int32_t node : data.contact_node) near[static_cast<std::size_t>(node)] = 0;
  data.green_node = data.contact_node;
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i] != 0) data.green_node.push_back(static_cast<std::int32_t>(i));
}

}  // namespace

ModelData syntheticModel(const SyntheticSize& size) {
  const Ellipsoid surface = ellipsoid(size.nodes, kSemiAxes);
  ModelData data;
  ModelAttributes& a = data.attributes;
  a.law = "stvk";
  a.provenance = R"({"program": "palpate-bench"})";
  a.E = 160e3;
  a.nu = 0.48;
  a.order = kOrder;
  a.force_order = kForceOrder;
  a.patch_radius = 1.3 * edgeOf(surface);
  a.near_radius = 0.025;
  a.reference_displacement = kReference;
  fillSurface(surface, data);
  fillMesh(surface, data);
  fillPositions(surface, size.positions, data);
  fillContact(surface, data);
  fillStiffness(data);
  fillLoaded(data);
  fillModes(surface, size.modes, kStiffness * kReference, data);
  fillNear(surface, kStiffness * kReference, data);
  return data;
}

}  // namespace palpate::bench
