// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/solver/fem/cholesky.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/fem/patch.h"

namespace palpate::solver {

/// Equilibrium at every load position at once, the problem of the paper's methods (Eq. 1, docs/design.md,
/// Reproduction):
///   f_int(u_s) = t l_s,  s = 1 .. M,  t in [0, 1].
/// M counts right-hand sides: load positions, or positions times directions. Vectors hold the unknowns (dofs)
/// only. Const functions may be called from any number of threads.
class ParametricProblem {
 public:
  virtual ~ParametricProblem() = default;

  [[nodiscard]] virtual int dofs() const noexcept = 0;
  /// l_s at full load, dofs x M, N.
  [[nodiscard]] virtual const SparseMatrix& loads() const noexcept = 0;
  /// Quadrature weights of the integral over the load positions (lumped areas or lengths), M, > 0.
  [[nodiscard]] virtual const Eigen::VectorXd& weights() const noexcept = 0;
  /// Writes K_T(u), both triangles, N/m, into `K`. @param[in,out] K  a copy of pattern(), overwritten
  virtual void tangent(const Eigen::VectorXd& u, SparseMatrix& K) const = 0;
  /// Nodal forces of the stresses at u, dofs, N.
  [[nodiscard]] virtual Eigen::VectorXd internalForce(const Eigen::VectorXd& u) const = 0;
  /// K_T(0), dofs x dofs, both triangles, N/m. Every tangent has its pattern.
  [[nodiscard]] virtual const SparseMatrix& stiffness() const noexcept = 0;

  [[nodiscard]] int positions() const noexcept { return static_cast<int>(loads().cols()); }

 protected:
  ParametricProblem() = default;
  ParametricProblem(const ParametricProblem&) = default;
  ParametricProblem& operator=(const ParametricProblem&) = default;
};

/// A body of tetrahedra under the loads of contact patches.                               paper Eqs. (1), (14)
class BodyProblem final : public ParametricProblem {
 public:
  /// @param loads  dofs x M, N; @param weights  M, > 0
  /// @throw std::invalid_argument when sizes do not fit
  BodyProblem(const FeModel& model, SparseMatrix loads, Eigen::VectorXd weights);

  [[nodiscard]] int dofs() const noexcept override { return model_.dofCount(); }
  [[nodiscard]] const SparseMatrix& loads() const noexcept override { return loads_; }
  [[nodiscard]] const Eigen::VectorXd& weights() const noexcept override { return weights_; }
  void tangent(const Eigen::VectorXd& u, SparseMatrix& K) const override;
  [[nodiscard]] Eigen::VectorXd internalForce(const Eigen::VectorXd& u) const override;
  [[nodiscard]] const SparseMatrix& stiffness() const noexcept override { return stiffness_; }

  [[nodiscard]] const FeModel& model() const noexcept { return model_; }
  /// Unknowns to nodal displacements, 3 N, zero at clamped nodes.
  [[nodiscard]] Eigen::VectorXd toNodes(const Eigen::VectorXd& unknowns) const;

 private:
  const FeModel& model_;
  SparseMatrix loads_;
  Eigen::VectorXd weights_;
  SparseMatrix stiffness_;
  std::vector<std::int32_t> places_;  ///< where each entry of each element's tangent goes, -1: nowhere
};

/// Loads f_j on each patch: column (s, j) = G_s f_j, position-major.                  docs/design.md, Symbols
/// @param forces  N; one for a load of fixed direction, the three unit vectors for any direction
/// @return dofs x (patches * forces)
[[nodiscard]] SparseMatrix patchLoads(const FeModel& model, std::span<const Patch> patches,
                                      std::span<const Vec3> forces);

}  // namespace palpate::solver
