// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/liver_organ.h"

#include <algorithm>

namespace palpate::reproduce {

solver::Case wholeBoundary(const std::filesystem::path& mesh) {
  solver::Case c = solver::defaultCase(mesh);
  c.E = 160e3;
  c.nu = 0.48;
  c.accessible.reset();
  return c;
}

solver::BodyProblem downwardProblem(const solver::SolverSetup& setup, double travel, double& load) {
  constexpr std::size_t kMost = 64;  // largest number of positions for the median
  const solver::Vec3 down(0.0, 0.0, -1.0);
  const solver::SparseMatrix unit = solver::patchLoads(setup.model, setup.positions.patches, {&down, 1});
  const std::vector<double> areas = setup.positionAreas();
  const Eigen::VectorXd weights = Eigen::Map<const Eigen::VectorXd>(areas.data(), Eigen::Index(areas.size()));
  const solver::BodyProblem problem(setup.model, unit, weights);
  const solver::Cholesky K0(problem.stiffness());
  const std::size_t count = setup.positions.patches.size(), step = std::max<std::size_t>(1, count / kMost);
  std::vector<double> moved;
  for (std::size_t s = 0; s < count; s += step) {
    const Eigen::VectorXd l = unit.col(Eigen::Index(s));
    const Eigen::VectorXd u = K0.solve(l);
    moved.push_back(setup.positions.patches[s].average(problem.toNodes(u)).norm());
  }
  std::nth_element(moved.begin(), moved.begin() + std::ptrdiff_t(moved.size() / 2), moved.end());
  load = travel / moved[moved.size() / 2];
  return {setup.model, load * unit, weights};
}

}  // namespace palpate::reproduce
