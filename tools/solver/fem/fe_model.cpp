// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/fe_model.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace palpate::solver {

FeModel::FeModel(std::vector<Vec3> nodes, std::vector<std::array<std::int32_t, 4>> tetrahedra,
                 std::vector<std::int32_t> fixed, const StVenantKirchhoff& material)
    : nodes_(std::move(nodes)),
      tetrahedra_(std::move(tetrahedra)),
      fixed_(std::move(fixed)),
      material_(material) {
  if (!(material.E > 0.0) || !(material.nu > -1.0) || !(material.nu < 0.5))
    throw std::invalid_argument("material: E = " + std::to_string(material.E) + " Pa, nu = " +
                                std::to_string(material.nu) + "; expected E > 0 and -1 < nu < 0.5");
  dofs_.assign(nodes_.size(), 0);
  for (const std::int32_t node : fixed_) {
    if (node < 0 || node >= nodeCount())
      throw std::invalid_argument("fixed node " + std::to_string(node) + " of " +
                                  std::to_string(nodeCount()));
    dofs_[index(node)] = -1;
  }
  for (int& dof : dofs_) {
    if (dof < 0) continue;
    dof = dof_count_;
    dof_count_ += 3;
  }
  computeGeometry();
}

void FeModel::computeGeometry() {
  gradients_.resize(tetrahedra_.size());
  volumes_.resize(tetrahedra_.size());
  for (int e = 0; e < elementCount(); ++e) {
    const auto& t = tetrahedra_[index(e)];
    for (const std::int32_t node : t)
      if (node < 0 || node >= nodeCount())
        throw std::invalid_argument("tetrahedron " + std::to_string(e) + ": node " + std::to_string(node) +
                                    " of " + std::to_string(nodeCount()));
    Mat3 edges;
    for (int a = 0; a < 3; ++a) edges.col(a) = nodes_[index(t[index(a + 1)])] - nodes_[index(t[0])];
    const double volume = edges.determinant() / 6.0;
    if (!(volume > 0.0))
      throw std::invalid_argument("tetrahedron " + std::to_string(e) + ": volume " + std::to_string(volume));
    const Mat3 inverse = edges.inverse();
    Gradients& g = gradients_[index(e)];
    g.bottomRows<3>() = inverse;
    g.row(0) = -inverse.colwise().sum();
    volumes_[index(e)] = volume;
  }
}

Mat3 FeModel::displacementGradient(int element, const Eigen::VectorXd& u) const noexcept {
  const auto& t = tetrahedra_[index(element)];
  Mat3 H = Mat3::Zero();
  for (int a = 0; a < 4; ++a) H += u.segment<3>(3 * t[index(a)]) * gradients_[index(element)].row(a);
  return H;
}

Eigen::VectorXd FeModel::internalForce(const Eigen::VectorXd& u) const {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * nodeCount());
  for (int e = 0; e < elementCount(); ++e) {
    const Mat3 H = displacementGradient(e, u);
    const Mat3 S = material_.stress(0.5 * (H + H.transpose() + H.transpose() * H));
    const Mat3 P = (Mat3::Identity() + H) * S;
    for (int a = 0; a < 4; ++a)
      f.segment<3>(3 * tetrahedra_[index(e)][index(a)]) += volume(e) * (P * gradients(e).row(a).transpose());
  }
  return f;
}

double FeModel::energy(const Eigen::VectorXd& u) const {
  double total = 0.0;
  for (int e = 0; e < elementCount(); ++e) {
    const Mat3 H = displacementGradient(e, u);
    const Mat3 E = 0.5 * (H + H.transpose() + H.transpose() * H);
    total += 0.5 * volume(e) * E.cwiseProduct(material_.stress(E)).sum();
  }
  return total;
}

Eigen::Matrix<double, 12, 12> FeModel::elementTangent(int element, const Eigen::VectorXd& u) const {
  const Mat3 H = displacementGradient(element, u);
  const Mat3 F = Mat3::Identity() + H;
  const Mat3 S = material_.stress(0.5 * (H + H.transpose() + H.transpose() * H));
  const double lambda = material_.lambda();
  const double mu = material_.mu();
  const Mat3 FFt = F * F.transpose();
  const Gradients& g = gradients(element);
  const Eigen::Matrix<double, 4, 3> Fg = g * F.transpose();  // row a: F dN_a
  Eigen::Matrix<double, 12, 12> K;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      // C for an isotropic body: lambda I(x)I + 2 mu sym, contracted with F dN_a and F dN_b.
      const double geometric = g.row(a) * S * g.row(b).transpose();
      const double dots = mu * g.row(a).dot(g.row(b));
      K.block<3, 3>(3 * a, 3 * b) = lambda * Fg.row(a).transpose() * Fg.row(b) +
                                    mu * Fg.row(b).transpose() * Fg.row(a) + dots * FFt +
                                    geometric * Mat3::Identity();
    }
  }
  return volume(element) * K;
}

double FeModel::minDetF(const Eigen::VectorXd& u) const {
  double smallest = std::numeric_limits<double>::infinity();
  for (int e = 0; e < elementCount(); ++e)
    smallest = std::min(smallest, (Mat3::Identity() + displacementGradient(e, u)).determinant());
  return smallest;
}

}  // namespace palpate::solver
