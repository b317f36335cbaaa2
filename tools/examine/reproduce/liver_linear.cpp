// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/liver_linear.h"

#include <algorithm>
#include <cmath>

#include "tools/solver/pgd/energy_error.h"
#include "tools/solver/pgd/linear_pgd.h"
#include "tools/solver/pgd/recompression.h"

namespace palpate::reproduce {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// At most 1.5 n.
Index greedyPairsFor(int pairs) {
  return static_cast<Index>(3 * pairs / 2);
}

/// The same span with X orthonormal in the energy and Y from Galerkin: the result of the update step for
/// these pairs.
solver::ScalarPairs galerkin(const solver::BodyProblem& problem, const MatrixXd& X) {
  MatrixXd Q = solver::orthonormalize(X, solver::energyProduct(problem.stiffness())).Q;
  MatrixXd Y = Q.transpose() * problem.loads();
  return {std::move(Q), std::move(Y)};
}

/// Sum over s of the squared amplitudes of each pair: its part of the energy.
VectorXd energies(const solver::ScalarPairs& pairs, const VectorXd& weights) {
  return pairs.Y.cwiseAbs2() * weights;
}

/// Linear finite elements at the held-out points, dofs x points.
MatrixXd solvePoints(const solver::FeModel& model, const solver::Cholesky& K0,
                     const std::vector<Touch>& points, const Vec3& load) {
  std::vector<solver::Patch> patches;
  for (const Touch& point : points) patches.push_back(point.patch);
  return K0.solve(MatrixXd(solver::patchLoads(model, patches, {&load, 1})));
}

/// Barycentric weights of the positions at each point, M x points.
solver::SparseMatrix mixing(const solver::SolverSetup& setup, const std::vector<Touch>& points) {
  std::vector<Index> position_of_node(setup.surface.nodes.size(), -1);
  for (std::size_t p = 0; p < setup.positions.nodes.size(); ++p)
    position_of_node[static_cast<std::size_t>(setup.positions.nodes[p])] = static_cast<Index>(p);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto node = setup.surface.faces[static_cast<std::size_t>(points[i].s.triangle)][c];
      entries.emplace_back(position_of_node[static_cast<std::size_t>(node)], static_cast<int>(i),
                           points[i].s.barycentric[c]);
    }
  solver::SparseMatrix B(static_cast<Index>(setup.positions.nodes.size()), static_cast<Index>(points.size()));
  B.setFromTriplets(entries.begin(), entries.end());
  return B;
}

/// 95 % quantiles over the points: largest error on the surface and error of the contact displacement, both
/// relative to the contact displacement.
Json pointErrors(const solver::SolverSetup& setup, const std::vector<Touch>& points, const MatrixXd& u,
                 const MatrixXd& truth) {
  std::vector<TouchError> errors(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MatrixXd error = (u - truth).col(static_cast<Index>(i));
    Vec3 d = Vec3::Zero(), off = Vec3::Zero();
    for (std::size_t j = 0; j < points[i].patch.nodes.size(); ++j) {
      const int dof = setup.model.dof(points[i].patch.nodes[j]);
      d += points[i].patch.weights[j] * truth.col(static_cast<Index>(i)).segment<3>(dof);
      off += points[i].patch.weights[j] * error.col(0).segment<3>(dof);
    }
    for (const std::int32_t node : setup.surface.nodes)
      if (setup.model.isFree(node))
        errors[i].field =
            std::max(errors[i].field, error.col(0).segment<3>(setup.model.dof(node)).norm() / d.norm());
    errors[i].contact = off.norm() / d.norm();
  }
  return {{"field_error_p95", quantile(errors, &TouchError::field, 0.95)},
          {"contact_error_p95", quantile(errors, &TouchError::contact, 0.95)}};
}

/// The references: linear finite elements at the points, and the best n pairs.
struct Truth {
  MatrixXd points;           ///< dofs x points
  solver::SparseMatrix mix;  ///< M x points
  VectorXd singular_values;
  double energy;  ///< sum_s w_s |u_s|^2
};

Truth solveForComparison(const solver::SolverSetup& setup, const solver::BodyProblem& problem,
                         const std::vector<Touch>& points, const Vec3& load, int workers, Json& linear) {
  const double start = now();
  const MatrixXd C = solver::complianceMatrix(problem, workers);
  Truth truth{{},
              mixing(setup, points),
              solver::energySingularValues(C, problem.weights()),
              C.diagonal().dot(problem.weights())};
  linear["svd_seconds"] = now() - start;
  const solver::Cholesky K0(problem.stiffness());
  truth.points = solvePoints(setup.model, K0, points, load);
  // The exact solutions at the nodes around each point, interpolated: an error that more pairs do not reduce.
  const MatrixXd mixed = K0.solve(MatrixXd(problem.loads() * truth.mix));
  linear["interpolation"] = pointErrors(setup, points, mixed, truth.points);
  return truth;
}

solver::SeparatedSolution enrich(const solver::BodyProblem& problem, const LiverOptions& options, Output& out,
                                 Json& linear) {
  solver::LinearPgdOptions pgd;
  pgd.max_pairs = std::min(static_cast<int>(greedyPairsFor(options.pairs.back())), problem.positions());
  pgd.tolerance = 0.0;
  pgd.workers = options.workers;
  pgd.quiet = out.quiet();
  const double start = now();
  solver::SeparatedSolution greedy = solver::solveLinearPgd(problem, pgd);
  linear["greedy_pairs"] = greedy.pairs();
  linear["residual"] = greedy.history.back().residual;
  linear["seconds"] = now() - start;
  std::vector<std::vector<double>> history;
  for (const solver::EnrichmentStep& step : greedy.history)
    history.push_back({double(step.pairs), step.residual, step.spread, step.seconds});
  out.writeCsv("linear-pgd-residual.csv", {"pairs", "residual", "spread", "seconds"}, history);
  return greedy;
}

/// n pairs recompressed from at most 1.5 n greedy ones, compared with the best n and the first n.
Json rowOf(const solver::BodyProblem& problem, const Truth& truth, const solver::ScalarPairs& first,
           const solver::ScalarPairs& cut, int n) {
  const auto error = [&](double captured) { return std::sqrt(std::max(0.0, 1.0 - captured / truth.energy)); };
  const double optimum = solver::bestError(truth.singular_values, n);
  const double kept = error(energies(cut, problem.weights()).sum());
  const double raw = error(energies(first, problem.weights()).head(std::min<Index>(n, first.X.cols())).sum());
  return {{"pairs", n},
          {"greedy_pairs", first.X.cols()},
          {"svd_energy_error", optimum},
          {"energy_error", kept},
          {"ratio", kept / optimum},
          {"raw_energy_error", raw},
          {"raw_ratio", raw / optimum}};
}

}  // namespace

solver::ScalarPairs studyLinear(const solver::SolverSetup& setup, const solver::BodyProblem& problem,
                                const std::vector<Touch>& points, const LiverOptions& options, Output& out,
                                Json& results) {
  Json linear;
  const Vec3 load(0.0, 0.0, -results["load_N"].get<double>());
  out.step("linear PGD, 1.5 x " + std::to_string(options.pairs.back()) + " greedy pairs");
  const solver::SeparatedSolution greedy = enrich(problem, options, out, linear);
  out.step("linear finite elements at all positions and held-out points, for comparison only");
  const Truth truth = solveForComparison(setup, problem, points, load, options.workers, linear);
  out.step("recompression");
  const solver::ScalarPairs all = galerkin(problem, greedy.X);
  solver::ScalarPairs shown;
  for (const int n : options.pairs) {
    const Index used = std::min<Index>(greedyPairsFor(n), all.X.cols());
    const solver::ScalarPairs first{all.X.leftCols(used), all.Y.topRows(used)};
    shown = solver::recompress(first, solver::energyProduct(problem.stiffness()), problem.weights(), n).pairs;
    Json row = rowOf(problem, truth, first, shown, n);
    addAll(row, pointErrors(setup, points, shown.X * (shown.Y * truth.mix), truth.points));
    linear["pairs_table"].push_back(row);
  }
  results["linear"] = linear;
  return shown;
}

}  // namespace palpate::reproduce
