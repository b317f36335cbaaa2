// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::solver {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Gradients = Eigen::Matrix<double, 4, 3>;  ///< row a: dN_a/dX, 1/m

/// Saint Venant-Kirchhoff: S = lambda tr(E) I + 2 mu E                            paper Eqs. (13), (15)
struct StVenantKirchhoff {
  double E{160e3};  ///< Young's modulus, Pa, > 0
  double nu{0.48};  ///< Poisson's ratio, in (-1, 0.5)

  [[nodiscard]] double lambda() const noexcept { return E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)); }
  [[nodiscard]] double mu() const noexcept { return E / (2.0 * (1.0 + nu)); }
  /// C : e for a symmetric e, Pa.
  [[nodiscard]] Mat3 stress(const Mat3& e) const noexcept {
    return lambda() * e.trace() * Mat3::Identity() + 2.0 * mu() * e;
  }
};

/// A body of linear tetrahedra, clamped at some nodes: the discrete problem that every solver here works on.
/// Nodal vectors u, f have 3 N entries, node-interleaved; the unknowns ("dofs") are those of the free nodes.
class FeModel {
 public:
  /// @param nodes  rest positions X, m  @param tetrahedra  0-based, positive volume  @param fixed  clamped
  /// nodes
  /// @throw std::invalid_argument naming the element or node that is degenerate or out of range
  FeModel(std::vector<Vec3> nodes, std::vector<std::array<std::int32_t, 4>> tetrahedra,
          std::vector<std::int32_t> fixed, const StVenantKirchhoff& material);

  [[nodiscard]] int nodeCount() const noexcept { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] int elementCount() const noexcept { return static_cast<int>(tetrahedra_.size()); }
  [[nodiscard]] int dofCount() const noexcept { return dof_count_; }
  [[nodiscard]] const std::vector<Vec3>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const std::vector<std::array<std::int32_t, 4>>& tetrahedra() const noexcept {
    return tetrahedra_;
  }
  [[nodiscard]] const std::vector<std::int32_t>& fixedNodes() const noexcept { return fixed_; }
  [[nodiscard]] const StVenantKirchhoff& material() const noexcept { return material_; }
  [[nodiscard]] const Gradients& gradients(int element) const noexcept { return gradients_[index(element)]; }
  [[nodiscard]] double volume(int element) const noexcept { return volumes_[index(element)]; }
  /// First unknown of a node (its x; y and z follow), -1 for a clamped node.
  [[nodiscard]] int dof(int node) const noexcept { return dofs_[index(node)]; }
  [[nodiscard]] bool isFree(int node) const noexcept { return dof(node) >= 0; }

  /// H = du/dX of one element, 3 x 3. @param u  nodal displacements, 3 N, m
  [[nodiscard]] Mat3 displacementGradient(int element, const Eigen::VectorXd& u) const noexcept;
  /// Nodal forces f_int = int P(u) : grad delta, 3 N, N.                          docs/design.md, Series
  [[nodiscard]] Eigen::VectorXd internalForce(const Eigen::VectorXd& u) const;
  /// Elastic energy int Psi(u), J.
  [[nodiscard]] double energy(const Eigen::VectorXd& u) const;
  /// Consistent tangent of one element, 12 x 12 node-interleaved, N/m.
  [[nodiscard]] Eigen::Matrix<double, 12, 12> elementTangent(int element, const Eigen::VectorXd& u) const;
  /// Smallest det F over the elements: at most 0 where an element is inside out.
  [[nodiscard]] double minDetF(const Eigen::VectorXd& u) const;

 private:
  static std::size_t index(int i) noexcept { return static_cast<std::size_t>(i); }
  void computeGeometry();

  std::vector<Vec3> nodes_;
  std::vector<std::array<std::int32_t, 4>> tetrahedra_;
  std::vector<std::int32_t> fixed_;
  StVenantKirchhoff material_;
  std::vector<Gradients> gradients_;
  std::vector<double> volumes_;
  std::vector<int> dofs_;
  int dof_count_{0};
};

}  // namespace palpate::solver
