// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "boxes.h"
#include "tools/solver/pgd/parametric_problem.h"

namespace palpate::solver {

/// Any K u_s = l_s.
class LinearProblem final : public ParametricProblem {
 public:
  LinearProblem(SparseMatrix K, SparseMatrix loads, Eigen::VectorXd weights)
      : K_(std::move(K)), loads_(std::move(loads)), weights_(std::move(weights)) {}
  int dofs() const noexcept override { return static_cast<int>(K_.rows()); }
  const SparseMatrix& loads() const noexcept override { return loads_; }
  const Eigen::VectorXd& weights() const noexcept override { return weights_; }
  void tangent(const Eigen::VectorXd&, SparseMatrix& K) const override { K = K_; }
  Eigen::VectorXd internalForce(const Eigen::VectorXd& u) const override { return K_ * u; }
  const SparseMatrix& stiffness() const noexcept override { return K_; }

 private:
  SparseMatrix K_, loads_;
  Eigen::VectorXd weights_;
};

/// A rod of n equal springs, clamped at one end, a unit force at each of its nodes: u = min(x, s).
inline LinearProblem springRod(int n) {
  std::vector<Eigen::Triplet<double>> entries, forces;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, i + 1 < n ? 2.0 : 1.0);
    if (i + 1 < n) entries.emplace_back(i, i + 1, -1.0);
    if (i > 0) entries.emplace_back(i, i - 1, -1.0);
    forces.emplace_back(i, i, 1.0);
  }
  SparseMatrix K(n, n), loads(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  loads.setFromTriplets(forces.begin(), forces.end());
  return {K, loads, Eigen::VectorXd::LinSpaced(n, 0.5, 1.5)};
}

/// A block clamped at one end, patches on every free node of its surface.
struct PalpatedBox {
  Box box{4, 2, 2, Vec3(0.08, 0.04, 0.04)};
  FeModel model{box.clamped({{160e3, 0.4}})};
  PatchSurface surface{box.surface(model)};
  std::vector<Patch> patches;
  std::vector<double> areas;

  PalpatedBox() {
    for (std::size_t i = 0; i < surface.nodes.size(); ++i) {
      if (!model.isFree(surface.nodes[i])) continue;
      patches.push_back(makePatch(model, surface, surface.atNode(static_cast<int>(i)), 0.02));
      areas.push_back(surface.areas[i]);
    }
  }
  /// A unit force in each direction at each position.
  BodyProblem problem(const std::vector<Vec3>& directions) const {
    const auto per_position = static_cast<Eigen::Index>(directions.size());
    Eigen::VectorXd weights(static_cast<Eigen::Index>(areas.size()) * per_position);
    for (Eigen::Index s = 0; s < weights.size(); ++s)
      weights[s] = areas[static_cast<std::size_t>(s / per_position)];
    return BodyProblem(model, patchLoads(model, patches, directions), weights);
  }
};

}  // namespace palpate::solver
