// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/energy_error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/solver/base/dense_decompositions.h"
#include "tools/solver/base/parallel.h"

namespace palpate::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBlock = 32;  // full solutions in memory at once, for each worker

/// visit(worker, first position, their full solutions), in any order, `workers` at once.
void forEachSolution(const ParametricProblem& problem, int workers,
                     const std::function<void(std::size_t, Index, const MatrixXd&)>& visit) {
  const Cholesky factor(problem.stiffness());
  factor.requirePositiveDefinite("the stiffness matrix");
  std::vector<std::unique_ptr<Cholesky::Solver>> solvers(static_cast<std::size_t>(workers));
  const Index count = problem.positions();
  parallelFor(workers, static_cast<std::size_t>((count + kBlock - 1) / kBlock),
              [&](int w, std::size_t chunk) {
                const auto worker = static_cast<std::size_t>(w);
                if (!solvers[worker]) solvers[worker] = std::make_unique<Cholesky::Solver>(factor);
                const Index first = static_cast<Index>(chunk) * kBlock;
                MatrixXd u = problem.loads().middleCols(first, std::min(kBlock, count - first));
                solvers[worker]->solveInPlace(u);
                visit(worker, first, u);
              });
}

}  // namespace

double energyError(const ParametricProblem& problem, const ScalarPairs& pairs, int workers) {
  if (pairs.X.rows() != problem.dofs() || pairs.Y.cols() != problem.positions() ||
      pairs.X.cols() != pairs.Y.rows())
    throw std::invalid_argument("pairs of " + std::to_string(pairs.X.rows()) + " unknowns and " +
                                std::to_string(pairs.Y.cols()) + " positions for a problem of " +
                                std::to_string(problem.dofs()) + " and " +
                                std::to_string(problem.positions()));
  struct Sums {
    double error{0.0}, energy{0.0};
  };
  std::vector<Sums> sums(static_cast<std::size_t>(workers));
  forEachSolution(problem, workers, [&](std::size_t worker, Index first, const MatrixXd& u) {
    const auto loads = problem.loads().middleCols(first, u.cols());
    const auto w = problem.weights().segment(first, u.cols()).transpose();
    const MatrixXd e = u - pairs.X * pairs.Y.middleCols(first, u.cols());
    const MatrixXd Ke = problem.stiffness() * e;
    sums[worker].error += e.cwiseProduct(Ke).colwise().sum().cwiseProduct(w).sum();
    sums[worker].energy += u.cwiseProduct(MatrixXd(loads)).colwise().sum().cwiseProduct(w).sum();
  });
  double error = 0.0;
  double energy = 0.0;
  for (const Sums& s : sums) {
    error += s.error;
    energy += s.energy;
  }
  return std::sqrt(std::max(0.0, error) / energy);
}

MatrixXd complianceMatrix(const ParametricProblem& problem, int workers) {
  MatrixXd C(problem.positions(), problem.positions());
  const SparseMatrix loads_T = problem.loads().transpose();
  forEachSolution(problem, workers, [&](std::size_t, Index first, const MatrixXd& u) {
    C.middleCols(first, u.cols()) = loads_T * u;
  });
  return 0.5 * (C + C.transpose());
}

VectorXd energySingularValues(const MatrixXd& compliance, const VectorXd& weights) {
  const VectorXd root = weights.cwiseSqrt();
  const MatrixXd A = root.asDiagonal() * compliance * root.asDiagonal();
  return eigenvalues(A).cwiseMax(0.0).cwiseSqrt();
}

double bestError(const VectorXd& singular_values, Index n) {
  const Index left = std::max<Index>(0, singular_values.size() - n);
  return std::sqrt(singular_values.tail(left).squaredNorm() / singular_values.squaredNorm());
}

}  // namespace palpate::solver
