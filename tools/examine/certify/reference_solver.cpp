// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/reference_solver.h"

#include <algorithm>

#include "tools/solver/base/lanes.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/series/series.h"

namespace palpate::certify {

namespace {

solver::NewtonOptions newtonOptions() {
  solver::NewtonOptions options;
  options.tolerance = 1e-8;  // far below what is certified
  options.held = 0.3;
  return options;
}

solver::NewtonOptions fromSeries() {
  solver::NewtonOptions options = newtonOptions();
  options.lost = 0.5;
  return options;
}

/// From rest, where the series leads nowhere: a touch is given up after minutes, not hours.
solver::NewtonOptions fromRest() {
  solver::NewtonOptions options = newtonOptions();
  options.steps = 4;
  options.max_iterations = 12;
  options.max_halvings = 2;
  options.extra_steps = 6;
  return options;
}

/// u = sum d^alpha U_alpha of the position in a lane.
Eigen::VectorXd fieldOf(const solver::SeriesSolver& series, int lane, const Vec3& d, int nodes) {
  std::vector<double> powers(static_cast<std::size_t>(series.basis().size()));
  series.basis().evaluate(d, powers);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * nodes);
  for (std::size_t k = 0; k < powers.size(); ++k)
    for (int node = 0; node < nodes; ++node)
      u.segment<3>(3 * node) += powers[k] * series.displacement(lane, static_cast<int>(k), node);
  return u;
}

}  // namespace

ReferenceSolver::ReferenceSolver(const query::Organ& organ, double patch_radius, int threads)
    : organ_(organ), patch_radius_(patch_radius), at_rest_(organ.body) {
  at_rest_.factorize(Eigen::VectorXd::Zero(3 * organ.body.nodeCount()));
  at_rest_.requirePositiveDefinite("the stiffness at rest");
  // One after the other: METIS orders by rand(), which threads would take from each other.
  for (int thread = 0; thread < threads; ++thread)
    newton_.push_back(std::make_unique<solver::NewtonSolver>(organ.body));
}

ReferenceSolver::~ReferenceSolver() = default;

solver::Patch ReferenceSolver::patchOf(const Touch& touch) const {
  return query::patchAt(organ_, {touch.s, touch.position, 0}, patch_radius_);
}

std::vector<Eigen::VectorXd> ReferenceSolver::starts(std::span<const Touch> touches) {
  constexpr int kOrder = 3;
  constexpr std::size_t kLanes = solver::kLanes;
  std::vector<Eigen::VectorXd> starts(touches.size());
  std::vector<std::unique_ptr<solver::SeriesSolver>> series(newton_.size());
  const auto solve = [&](int thread, std::size_t chunk) {
    auto& own = series[static_cast<std::size_t>(thread)];
    if (!own)
      own =
          std::make_unique<solver::SeriesSolver>(organ_.body, at_rest_, solver::SeriesOrders{kOrder, kOrder});
    const auto part = touches.subspan(kLanes * chunk, std::min(kLanes, touches.size() - kLanes * chunk));
    std::vector<solver::Patch> patches;
    for (const Touch& touch : part) patches.push_back(patchOf(touch));
    own->solve(patches);
    for (std::size_t i = 0; i < part.size(); ++i)
      starts[kLanes * chunk + i] = fieldOf(*own, static_cast<int>(i), part[i].d, organ_.body.nodeCount());
  };
  solver::parallelFor(static_cast<int>(newton_.size()), (touches.size() + kLanes - 1) / kLanes, solve);
  return starts;
}

std::optional<query::FullSolution> ReferenceSolver::solve(std::span<const Touch> touches,
                                                          const Eigen::VectorXd& start, int thread) {
  solver::NewtonSolver& newton = *newton_[static_cast<std::size_t>(thread)];
  std::vector<solver::ImposedPatch> tools;
  for (const Touch& touch : touches) tools.push_back({patchOf(touch), touch.d});
  query::FullSolution solution;
  solution.patch = tools.front().patch;
  solution.d = tools.front().d;
  if (auto state = newton.solvePatchesFrom(start, tools, fromSeries())) {
    solution.min_det_f = organ_.body.minDetF(state->u);
    solution.state = std::move(*state);
    if (solution.min_det_f > 0.0) return solution;
  }
  try {
    solution.state = newton.solvePatches(tools, fromRest());
  } catch (const solver::NoConvergence&) {
    return std::nullopt;  // the caller counts it
  }
  solution.min_det_f = organ_.body.minDetF(solution.state.u);
  if (solution.min_det_f <= 0.0) return std::nullopt;  // an element is inside out: no state of an organ
  return solution;
}

}  // namespace palpate::certify
