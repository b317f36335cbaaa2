// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/synthetic_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/multi_index.h"
#include "core/surface/smooth_places.h"
#include "icosphere.h"
#include "synthetic_mesh.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

namespace {

using modelfile::ModelData;

const Vec3 kLoadDirection(0.0, 0.6, -0.8);
constexpr int kLinear = static_cast<int>(kLinearCoefficients);

/// What the polynomials are ones in, and the size of an energy.
struct Scale {
  double reference;  ///< d_ref, m, or f_ref, N
  double energy;     ///< J
};

Scale scaleOf(const SyntheticOptions& o) {
  const double d = o.reference_displacement, f = o.reference_force;
  if (o.parameters == Parameters::kForce) return {f, f * f / o.stiffness};
  return {d, o.stiffness * d * d};
}

/// Coefficient of x^beta, x = d / d_ref, in the energy at X, J: quadratic part (k/2)(|d|^2 + (n.d)^2 / 2),
/// and small smooth higher terms that differ from place to place. The same of f / f_ref in the complementary
/// energy.
double energyCoefficient(const SyntheticOptions& o, const Vec3& X, const MultiIndex& beta) {
  const Vec3 n = X.normalized();
  const double scale = scaleOf(o).energy * (1.0 + o.contrast * std::sin(3.0 * n.x() + 2.0 * n.y() + n.z()));
  const int degree = beta[0] + beta[1] + beta[2];
  if (degree == 1) return 0.0;
  if (degree > 2) {
    const double phase = 3.0 * n.x() * beta[0] + 2.0 * n.y() * beta[1] + n.z() * beta[2] + degree;
    return scale * o.nonlinearity * std::sin(phase) / (degree * degree);
  }
  std::array<Eigen::Index, 2> axis{};
  std::size_t found = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (int times = 0; times < beta[i]; ++times) axis[found++] = static_cast<Eigen::Index>(i);
  const double mixed = 0.5 * n[axis[0]] * n[axis[1]];
  return axis[0] == axis[1] ? 0.5 * scale * (1.0 + mixed) : scale * mixed;
}

int forceOrder(const SyntheticOptions& o) {
  return o.force_order == 0 ? o.order : o.force_order;
}

double window(double r, double radius) {
  const double x = r / radius;
  return x < 1.0 ? (1.0 - x * x) * (1.0 - x * x) : 0.0;
}

/// An invented answer of the surface at distance r to the monomial alpha, m.
Vec3 nearValue(const SyntheticOptions& o, const MultiIndex& alpha, double r) {
  const double degree = alpha[0] + alpha[1] + alpha[2];
  const Vec3 along(alpha[0], alpha[1], alpha[2]);
  return o.reference_displacement * window(r, o.near_radius) * 0.5 * along / (degree * degree * degree);
}

void fillSurface(const SyntheticOptions& o, const Icosphere& sphere, ModelData& data) {
  for (const Vec3& n : sphere.nodes) {
    const Vec3 X = o.radius * n;
    data.surface_positions.insert(data.surface_positions.end(), {X.x(), X.y(), X.z()});
    const auto node = static_cast<std::int32_t>(data.surface_mesh_tag.size());
    data.surface_mesh_tag.push_back(node + 1);
    data.mesh_surface_node.push_back(node);
    const bool fixed = n.z() < o.fixed_below;
    data.position_of_node.push_back(fixed ? -1 : static_cast<std::int32_t>(data.contact_node.size()));
    if (fixed) {
      data.mesh_fixed.push_back(node);
      continue;
    }
    data.contact_node.push_back(node);
    data.contact_accessible.push_back(n.z() < o.helper_below ? 0 : 1);
    data.contact_domain_radius.push_back(o.parameters == Parameters::kForce   ? o.domain_force
                                         : o.parameters == Parameters::kLevel ? o.domain_level
                                                                              : o.domain_radius);
  }
  for (const auto& triangle : sphere.triangles)
    data.surface_triangles.insert(data.surface_triangles.end(), triangle.begin(), triangle.end());
}

/// The gradient of the energy, coefficient by coefficient: f of d, or d of f.
void fillContact(const SyntheticOptions& o, const Vec3& X, const MonomialBasis& basis,
                 std::vector<double>& values) {
  for (int k = 0; k < basis.size(); ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      MultiIndex beta = basis[k];
      ++beta[axis];  // f_i = dW/dd_i: the coefficient of x^alpha is (alpha_i + 1) w_{alpha + e_i} / d_ref
      values.push_back(beta[axis] * energyCoefficient(o, X, beta) / scaleOf(o).reference);
    }
}

/// d_q, m: mostly along the load, the first the largest.
void fillLevelContact(const SyntheticOptions& o, const Vec3& X, std::vector<double>& values) {
  for (int q = 0; q < o.level_functions; ++q) {
    const Vec3 d = o.load / o.stiffness * (kLoadDirection + 0.2 * X.normalized()) * (q == 0 ? 1.0 : 0.2 / q);
    values.insert(values.end(), {d.x(), d.y(), d.z()});
  }
}

void fillLevels(const SyntheticOptions& o, ModelData& data) {
  data.attributes.load = o.load;
  data.attributes.load_direction = {kLoadDirection.x(), kLoadDirection.y(), kLoadDirection.z()};
  for (int q = 0; q < o.level_functions; ++q)
    for (int step = 0; step <= o.level_steps; ++step)
      data.levels_Z.push_back(std::pow(double(step) / o.level_steps, q + 1));
}

/// K at X.
Mat3 stiffnessAt(const SyntheticOptions& o, const Vec3& X) {
  const double d = o.reference_displacement;
  Mat3 K;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      MultiIndex beta{};
      ++beta[i], ++beta[j];
      K(Eigen::Index(i), Eigen::Index(j)) = beta[i] * energyCoefficient(o, X, beta) / (d * d);
    }
  return K;
}

}  // namespace

void fillStiffness(ModelData& data, const std::function<Mat3(const Vec3&)>& stiffness) {
  constexpr double kStep = 5e-7;  // m
  const SmoothPlaces places(data.surface_positions, data.surface_triangles, data.position_of_node);
  data.contact_stiffness.clear();
  for (std::size_t place = 0; place < places.size(); ++place) {
    const ContactPoint& s = places.views(place).front().s;
    Vec3 X = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto node =
          static_cast<std::size_t>(data.surface_triangles[3 * static_cast<std::size_t>(s.triangle) + k]);
      X += s.barycentric[k] * Eigen::Map<const Vec3>(data.surface_positions.data() + 3 * node);
    }
    const Mat3 K = stiffness(X);
    std::array<Mat3, 3> slope;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      slope[static_cast<std::size_t>(axis)] =
          (stiffness(X + kStep * Vec3::Unit(axis)) - stiffness(X - kStep * Vec3::Unit(axis))) / (2.0 * kStep);
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index j = i; j < 3; ++j) {
        data.contact_stiffness.push_back(K(i, j));
        for (const Mat3& part : slope) data.contact_stiffness.push_back(part(i, j));
      }
  }
}

namespace {

/// An invented amplitude of one mode for one coefficient, m.
double amplitude(const SyntheticOptions& o, const Vec3& n, int k, int mode) {
  return o.reference_displacement * std::sin(n.x() + 2.0 * n.y() + 3.0 * n.z() + mode) /
         ((k + 1.0) * (mode + 1.0));
}

/// Unit loads at the nodes that have contact positions, so that a load K d there gives about the first three coefficients at d_ref.
void fillGreens(const SyntheticOptions& o, const Icosphere& sphere, const MonomialBasis& basis,
                ModelData& data) {
  constexpr double kSpread =
      1.8;  // the patch spreads its load: in its middle it dents by about 1 / kSpread of this
  data.green_node = data.contact_node;
  data.green_offset.push_back(0);
  for (const std::int32_t node : data.contact_node) {
    const Vec3& n = sphere.nodes[static_cast<std::size_t>(node)];
    const Mat3 per_load = stiffnessAt(o, o.radius * n).inverse() / o.reference_displacement;
    for (Eigen::Index load = 0; load < 3; ++load)
      for (int mode = 0; mode < o.modes; ++mode) {
        double y = 0.0;
        for (int k = 0; k < 3; ++k) y += amplitude(o, n, k, mode) * per_load(k, load);
        data.green_Y.push_back(static_cast<float>(y));
      }
    std::vector<Mat3> near;
    for (std::size_t i = 0; i < sphere.nodes.size(); ++i) {
      const double r = o.radius * (sphere.nodes[i] - n).norm();
      if (r >= o.near_radius) continue;
      data.green_near_node.push_back(static_cast<std::int32_t>(i));
      Mat3 u;
      for (int k = 0; k < 3; ++k) u.col(k) = kSpread * nearValue(o, basis[k], r);
      near.emplace_back(u * per_load);
    }
    for (Eigen::Index load = 0; load < 3; ++load)
      for (const Mat3& u : near)
        for (Eigen::Index axis = 0; axis < 3; ++axis)
          data.green_near.push_back(static_cast<float>(u(axis, load)));
    data.green_offset.push_back(static_cast<std::int64_t>(data.green_near_node.size()));
  }
}

/// @param first  coefficient that modes have
void fillModes(const SyntheticOptions& o, const Icosphere& sphere, int first, int coefficients,
               ModelData& data) {
  for (int mode = 0; mode < o.modes; ++mode)
    for (const Vec3& n : sphere.nodes)
      for (int axis = 0; axis < 3; ++axis)
        data.modes_X.push_back(static_cast<float>(0.1 * std::cos((mode + 1) * n[(axis + mode) % 3] + axis)));
  for (const std::int32_t node : data.contact_node)
    for (int k = first; k < coefficients; ++k)
      for (int mode = 0; mode < o.modes; ++mode)
        data.modes_Y.push_back(
            static_cast<float>(amplitude(o, sphere.nodes[static_cast<std::size_t>(node)], k, mode)));
}

void fillNoNear(ModelData& data) {
  data.attributes.near_radius = 0.0;
  data.near_offset.assign(data.contact_node.size() + 1, 0);
}

void fillNear(const SyntheticOptions& o, const Icosphere& sphere, const MonomialBasis& basis,
              ModelData& data) {
  data.near_offset.push_back(0);
  for (const std::int32_t node : data.contact_node) {
    const Vec3 X = o.radius * sphere.nodes[static_cast<std::size_t>(node)];
    const std::size_t first = data.near_node.size();
    for (std::size_t i = 0; i < sphere.nodes.size(); ++i)
      if ((o.radius * sphere.nodes[i] - X).norm() < o.near_radius)
        data.near_node.push_back(static_cast<std::int32_t>(i));
    for (int k = kLinear; k < basis.size(); ++k)
      for (std::size_t i = first; i < data.near_node.size(); ++i) {
        const Vec3 there = o.radius * sphere.nodes[static_cast<std::size_t>(data.near_node[i])];
        const Vec3 u = nearValue(o, basis[k], (there - X).norm());
        for (int axis = 0; axis < 3; ++axis) data.near_field.push_back(static_cast<float>(u[axis]));
      }
    data.near_offset.push_back(static_cast<std::int64_t>(data.near_node.size()));
  }
}

/// What edges add: as near fields of positions, smaller, and another one for each edge.
void fillEdges(const SyntheticOptions& o, const Icosphere& sphere, ModelData& data) {
  data.edge_order = std::min(o.order, 3);
  const MonomialBasis basis(data.edge_order);
  const SmoothPlaces places(data.surface_positions, data.surface_triangles, data.position_of_node);
  data.edge_offset.push_back(0);
  for (std::size_t place = data.contact_node.size(); place < places.size(); ++place) {
    const ContactPoint& s = places.views(place).front().s;
    Vec3 X = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      X += s.barycentric[k] * o.radius *
           sphere.nodes[static_cast<std::size_t>(
               data.surface_triangles[3 * static_cast<std::size_t>(s.triangle) + k])];
    const std::size_t first = data.edge_node.size();
    const auto radius = [&](std::int32_t node) {
      return 1.2 * (o.radius * sphere.nodes[static_cast<std::size_t>(node)] - X).norm();
    };
    for (std::int32_t node = 0; node < static_cast<std::int32_t>(sphere.nodes.size()); ++node)
      if (radius(node) < o.near_radius) data.edge_node.push_back(node);
    const double size = 0.01 + 0.002 * static_cast<double>(place % 7);
    for (int k = kLinear; k < basis.size(); ++k)
      for (std::size_t i = first; i < data.edge_node.size(); ++i) {
        const Vec3 u = size * nearValue(o, basis[k], radius(data.edge_node[i]));
        for (const double number : u) data.edge_field.push_back(static_cast<float>(number));
      }
    data.edge_offset.push_back(static_cast<std::int64_t>(data.edge_node.size()));
  }
}

}  // namespace

ModelData syntheticModel(const SyntheticOptions& o) {
  const Icosphere sphere = icosphere(o.subdivisions);
  const MonomialBasis basis(o.order), force_basis(forceOrder(o));
  ModelData data;
  data.attributes = {"stvk",        R"({"program": "synthetic", "fit_error": 0.0})",
                     160e3,         0.48,
                     o.order,       0.008,
                     o.near_radius, o.reference_displacement};
  data.attributes.force_order = force_basis.order();
  data.attributes.parameters = o.parameters;
  data.attributes.reference_force = o.reference_force;
  fillSurface(o, sphere, data);
  const bool level = o.parameters == Parameters::kLevel, force = o.parameters == Parameters::kForce;
  for (const std::int32_t node : data.contact_node) {
    const Vec3 X = o.radius * sphere.nodes[static_cast<std::size_t>(node)];
    if (level)
      fillLevelContact(o, X, data.contact_displacement);
    else
      fillContact(o, X, force_basis, force ? data.contact_displacement : data.contact_force);
  }
  if (level) fillLevels(o, data);
  fillModes(o, sphere, level || force ? 0 : kLinear, level ? o.level_functions : basis.size(), data);
  if (level || force) {
    fillNoNear(data);
  } else {
    fillNear(o, sphere, basis, data);
    fillGreens(o, sphere, basis, data);
    fillStiffness(data, [&](const Vec3& X) { return stiffnessAt(o, X); });
    if (o.order > 1) fillEdges(o, sphere, data);
    data.contact_series_radius.assign(data.contact_node.size(), std::max(o.series_radius, o.domain_radius));
  }
  fillSyntheticMesh(o, sphere, data);
  return data;
}

void writeSyntheticModel(const std::filesystem::path& path, const SyntheticOptions& options) {
  modelfile::writeModel(path, syntheticModel(options));
}

double syntheticEnergy(const SyntheticOptions& o, const Vec3& X, const Vec3& d) {
  const MonomialBasis basis(forceOrder(o) + 1);
  std::vector<double> monomial(static_cast<std::size_t>(basis.size()));
  basis.evaluate(d / scaleOf(o).reference, monomial);
  double energy = 0.0;
  for (int k = 0; k < basis.size(); ++k)
    energy += energyCoefficient(o, X, basis[k]) * monomial[static_cast<std::size_t>(k)];
  return energy;
}

}  // namespace palpate::testing
