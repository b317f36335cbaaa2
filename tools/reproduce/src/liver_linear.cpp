// SPDX-License-Identifier: Apache-2.0
#include "liver_linear.h"

#include <algorithm>
#include <cmath>

#include "palpate/offline/energy_error.h"
#include "palpate/offline/linear_pgd.h"
#include "palpate/offline/recompression.h"

namespace palpate::reproduce {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// At most 1.5 n.
Index greedyPairsFor(int pairs) {
  return static_cast<Index>(3 * pairs / 2);
}

/// Same span, X orthonormal in the energy, Y Galerkin: what the update step makes of any number of first pairs.
offline::ScalarPairs galerkin(const offline::BodyProblem& problem, const MatrixXd& X) {
  MatrixXd Q = offline::orthonormalize(X, offline::energyProduct(problem.stiffness())).Q;
  MatrixXd Y = Q.transpose() * problem.loads();
  return {std::move(Q), std::move(Y)};
}

/// Sum over s of the squared amplitudes of each pair: what it holds of the energy.
VectorXd energies(const offline::ScalarPairs& pairs, const VectorXd& weights) {
  return pairs.Y.cwiseAbs2() * weights;
}

/// Linear finite elements at the held-out points, dofs x points.
MatrixXd solvePoints(const offline::FeModel& model, const offline::Cholesky& K0,
                     const std::vector<Touch>& points, const Vec3& load) {
  std::vector<offline::Patch> patches;
  for (const Touch& point : points) patches.push_back(point.patch);
  return K0.solve(MatrixXd(offline::patchLoads(model, patches, {&load, 1})));
}

/// Columns of Y at the points, mixed barycentrically between the positions.
MatrixXd atPoints(const offline::SolverSetup& setup, const std::vector<Touch>& points, const MatrixXd& Y) {
  std::vector<Index> position_of_node(setup.surface.nodes.size(), -1);
  for (std::size_t p = 0; p < setup.positions.nodes.size(); ++p)
    position_of_node[static_cast<std::size_t>(setup.positions.nodes[p])] = static_cast<Index>(p);
  MatrixXd mixed = MatrixXd::Zero(Y.rows(), static_cast<Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto node = setup.surface.triangles[static_cast<std::size_t>(points[i].s.triangle)][c];
      mixed.col(static_cast<Index>(i)) +=
          points[i].s.barycentric[c] * Y.col(position_of_node[static_cast<std::size_t>(node)]);
    }
  return mixed;
}

/// 95 % quantiles over the points: largest error on the surface and error of the contact displacement, of the latter.
Json pointErrors(const offline::SolverSetup& setup, const std::vector<Touch>& points, const MatrixXd& u,
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

/// The exact solutions at the nodes around each point, mixed: what no number of pairs takes away.
MatrixXd interpolated(const offline::SolverSetup& setup, const offline::BodyProblem& problem,
                      const offline::Cholesky& K0, const std::vector<Touch>& points) {
  const MatrixXd loads = atPoints(setup, points, MatrixXd(problem.loads()));
  return K0.solve(loads);
}

}  // namespace

offline::ScalarPairs studyLinear(const offline::SolverSetup& setup, const offline::BodyProblem& problem,
                                 const std::vector<Touch>& points, const LiverOptions& options, Output& out,
                                 Json& results) {
  Json& linear = results["linear"];
  const Vec3 load(0.0, 0.0, -results["load_N"].get<double>());
  offline::LinearPgdOptions pgd;
  pgd.max_pairs =
      static_cast<int>(greedyPairsFor(*std::max_element(options.pairs.begin(), options.pairs.end())));
  pgd.tolerance = 0.0;
  pgd.workers = options.workers;
  pgd.quiet = out.quiet();
  out.step("linear PGD, " + std::to_string(pgd.max_pairs) + " greedy pairs");
  double start = now();
  const offline::SeparatedSolution greedy = offline::solveLinearPgd(problem, pgd);
  linear["greedy_pairs"] = greedy.pairs();
  linear["residual"] = greedy.history.back().residual;
  linear["seconds"] = now() - start;
  std::vector<std::vector<double>> history;
  for (const offline::EnrichmentStep& step : greedy.history)
    history.push_back({double(step.pairs), step.residual, step.spread, step.seconds});
  out.writeCsv("linear-pgd-residual.csv", {"pairs", "residual", "spread", "seconds"}, history);

  out.step("the best possible: all linear solutions, for comparison only");
  start = now();
  const MatrixXd C = offline::complianceMatrix(problem, options.workers);
  const VectorXd best = offline::energySingularValues(C, problem.weights());
  const double total = C.diagonal().dot(problem.weights());
  linear["svd_seconds"] = now() - start;

  out.step("recompression, and linear finite elements at held-out points");
  const offline::Cholesky K0(problem.stiffness());
  const MatrixXd truth = solvePoints(setup.model, K0, points, load);
  const MatrixXd mixed = interpolated(setup, problem, K0, points);
  linear["interpolation"] = pointErrors(setup, points, mixed, truth);
  const offline::ScalarPairs all = galerkin(problem, greedy.X);
  offline::ScalarPairs shown;
  const auto error = [&](double captured) { return std::sqrt(std::max(0.0, 1.0 - captured / total)); };
  for (const int n : options.pairs) {
    const Index used = std::min<Index>(greedyPairsFor(n), all.X.cols());
    const offline::ScalarPairs first{all.X.leftCols(used), all.Y.topRows(used)};
    const offline::Recompressed cut =
        offline::recompress(first, offline::energyProduct(problem.stiffness()), problem.weights(), n);
    const double optimum = offline::bestError(best, n);
    const double kept = error(energies(cut.pairs, problem.weights()).sum());
    const double raw = error(energies(first, problem.weights()).head(std::min<Index>(n, used)).sum());
    Json row{{"pairs", n},
             {"greedy_pairs", used},
             {"svd_energy_error", optimum},
             {"energy_error", kept},
             {"ratio", kept / optimum},
             {"raw_energy_error", raw},
             {"raw_ratio", raw / optimum}};
    row.update(pointErrors(setup, points, cut.pairs.X * atPoints(setup, points, cut.pairs.Y), truth));
    linear["pairs_table"].push_back(row);
    shown = cut.pairs;
  }
  return shown;
}

}  // namespace palpate::reproduce
