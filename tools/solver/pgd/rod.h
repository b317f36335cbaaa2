// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/solver/pgd/parametric_problem.h"

namespace palpate::solver {

/// The rod of the paper's validation, its length, section, material and full load.        paper 4.1, docs/design.md, Reproduction
struct RodData {
  double length{0.4};   ///< L, m, > 0
  double area{1.6e-3};  ///< A, m^2, > 0
  double E{1e6};        ///< Young's modulus, Pa, > 0
  double force{320.0};  ///< F, N, along the axis
  int elements{40};     ///< of equal length, >= 1

  /// K = F / EA, 1.
  [[nodiscard]] double loadNumber() const noexcept { return force / (E * area); }
};

/// One-dimensional Saint Venant-Kirchhoff rod, clamped at x = 0, pulled by F at any of its nodes.   paper 4.1
///   P = E A (l^3 - l) / 2, l = 1 + du/dX the stretch; linear elements, so that nodal values are exact.
/// One unknown per node, node i at x = (i + 1) L / N; position s_i is node i, its weight the lumped length.
class RodProblem final : public ParametricProblem {
 public:
  /// @throw std::invalid_argument naming the first value that is out of range
  explicit RodProblem(const RodData& data);

  [[nodiscard]] int dofs() const noexcept override { return data_.elements; }
  [[nodiscard]] const SparseMatrix& loads() const noexcept override { return loads_; }
  [[nodiscard]] const Eigen::VectorXd& weights() const noexcept override { return weights_; }
  void tangent(const Eigen::VectorXd& u, SparseMatrix& K) const override;
  [[nodiscard]] Eigen::VectorXd internalForce(const Eigen::VectorXd& u) const override;
  [[nodiscard]] const SparseMatrix& stiffness() const noexcept override { return stiffness_; }

  [[nodiscard]] const RodData& data() const noexcept { return data_; }
  /// h, m.
  [[nodiscard]] double elementLength() const noexcept { return data_.length / data_.elements; }
  /// du/dX of each element, 1.
  [[nodiscard]] Eigen::VectorXd strain(const Eigen::VectorXd& u) const;
  /// Nodal forces of axial forces in the elements, N.
  [[nodiscard]] Eigen::VectorXd nodalForce(const Eigen::VectorXd& axial) const;

 private:
  RodData data_;
  SparseMatrix loads_;
  Eigen::VectorXd weights_;
  SparseMatrix stiffness_;
};

/// Stretch under the load number K: the real root l > 1/sqrt(3) of l^3 - l = 2 K.            paper Eqs. (20)-(21)
/// Above K = 1/sqrt(27) it is b + 1 / (3 b) as in the paper; below, where the paper's root is complex, the same
/// number by cosines. @param K  >= 0 (std::invalid_argument otherwise)
[[nodiscard]] double exactStretch(double K);
/// Tip displacement under a load at the tip, (l - 1) L, m: Eq. (20) with the factor L that it lacks.
[[nodiscard]] double exactTip(double K, double length);
/// u(x, s) = (l - 1) min(x, s) at full load: nodes x positions, m.
[[nodiscard]] Eigen::MatrixXd exactSolution(const RodProblem& rod);

/// Displacement-driven series at one node of the rod: u = sum_m d^m U_m, f = sum_m d^m f_m.   docs/design.md, Series
struct RodSeries {
  Eigen::MatrixXd U;  ///< nodes x order, m^(1-m)
  Eigen::VectorXd f;  ///< order, N m^-m

  /// f(d), N. @param d  displacement of the node, m
  [[nodiscard]] double force(double d) const;
  /// d with f(d) = force, by Newton from the linear answer. @throw std::runtime_error when it does not converge
  [[nodiscard]] double displacement(double force) const;
};

/// The recursion of docs/design.md, Series in one dimension, with K0 of the discrete rod. The force of the rod is a cubic in
/// d: order 3 is exact.
/// @param node  0 .. elements - 1  @param order  >= 1  (std::invalid_argument otherwise)
[[nodiscard]] RodSeries rodSeries(const RodProblem& rod, int node, int order);

}  // namespace palpate::solver
