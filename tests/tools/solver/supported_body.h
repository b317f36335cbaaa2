// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "tools/mesh/tet_mesh.h"
#include "tools/solver/pgd/parametric_problem.h"

namespace palpate::solver {

/// A body in linear elasticity, any components of the displacement given at any nodes: rollers, frictionless punches.
class SupportedBody {
 public:
  /// @param given  by component, 3 N
  SupportedBody(const mesh::TetMesh& mesh, const Material& material, std::vector<bool> given)
      : model_(mesh.nodes, {mesh.tetrahedra, mesh.midsides}, {}, material),
        given_(std::move(given)),
        K_(BodyProblem(model_, SparseMatrix(model_.dofCount(), 1), Eigen::VectorXd::Ones(1)).stiffness()),
        factor_(withoutGiven()) {
    factor_.factorize(withoutGiven());
  }
  [[nodiscard]] const FeModel& model() const noexcept { return model_; }
  [[nodiscard]] Eigen::VectorXd zero() const { return Eigen::VectorXd::Zero(K_.rows()); }
  /// Displacement, 3 N, m. @param u  given components, m, the others 0  @param f  loads, N
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& u, const Eigen::VectorXd& f) const {
    Eigen::VectorXd rest = f - K_ * u;
    for (std::size_t i = 0; i < given_.size(); ++i)
      if (given_[i]) rest[static_cast<Eigen::Index>(i)] = 0.0;
    return u + factor_.solve(rest);
  }
  /// Forces that hold the body at u, 3 N, N.
  [[nodiscard]] Eigen::VectorXd force(const Eigen::VectorXd& u) const { return K_ * u; }

 private:
  /// K where given components stand alone: without a load they stay 0.
  [[nodiscard]] SparseMatrix withoutGiven() const {
    const auto is_given = [&](Eigen::Index i) { return given_[static_cast<std::size_t>(i)]; };
    SparseMatrix K = K_;
    K.prune([&](Eigen::Index row, Eigen::Index column, double) {
      return row == column || (!is_given(row) && !is_given(column));
    });
    return K;
  }

  FeModel model_;
  std::vector<bool> given_;
  SparseMatrix K_;
  Cholesky factor_;
};

}  // namespace palpate::solver
