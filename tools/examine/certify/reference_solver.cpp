// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/reference_solver.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

double monomial(const MultiIndex& alpha, const Vec3& d) {
  double product = 1.0;
  for (std::size_t c = 0; c < 3; ++c) product *= std::pow(d[static_cast<Eigen::Index>(c)], alpha[c]);
  return product;
}

}  // namespace

ReferenceSolver::ReferenceSolver(const query::Organ& organ, double patch_radius, int threads)
    : organ_(organ), patch_radius_(patch_radius), at_rest_(organ.body) {
  at_rest_.factorize(Eigen::VectorXd::Zero(3 * organ.body.nodeCount()));
  at_rest_.requirePositiveDefinite("the stiffness at rest");
  newton_.resize(static_cast<std::size_t>(threads));
  solver::parallelFor(threads, newton_.size(), [&](int /*thread*/, std::size_t i) {
    newton_[i] = std::make_unique<solver::NewtonSolver>(organ.body);
  });
}

ReferenceSolver::~ReferenceSolver() = default;

solver::Patch ReferenceSolver::patchOf(const Touch& touch) const {
  return query::patchAt(organ_, {touch.s, touch.position, 0}, patch_radius_);
}

std::vector<Eigen::VectorXd> ReferenceSolver::starts(std::span<const Touch> touches) {
  constexpr int kOrder = 3;
  constexpr std::size_t kLanes = solver::kLanes;
  std::vector<Eigen::VectorXd> starts(touches.size(), Eigen::VectorXd::Zero(3 * organ_.body.nodeCount()));
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
      for (int k = 0; k < MonomialBasis::size(kOrder); ++k) {
        const double factor = monomial(own->basis()[k], part[i].d);
        for (int node = 0; node < organ_.body.nodeCount(); ++node)
          starts[kLanes * chunk + i].segment<3>(3 * node) +=
              factor * own->displacement(static_cast<int>(i), k, node);
      }
  };
  solver::parallelFor(static_cast<int>(newton_.size()), (touches.size() + kLanes - 1) / kLanes, solve);
  return starts;
}

std::optional<query::FullSolution> ReferenceSolver::solve(const Touch& touch, const Eigen::VectorXd& start,
                                                          int thread) {
  solver::NewtonSolver& newton = *newton_[static_cast<std::size_t>(thread)];
  query::FullSolution solution;
  solution.patch = patchOf(touch);
  solution.d = touch.d;
  if (auto state = newton.solvePatchFrom(start, solution.patch, touch.d, newtonOptions())) {
    solution.state = std::move(*state);
  } else {
    try {
      solution.state = newton.solvePatch(solution.patch, touch.d, newtonOptions());
    } catch (const std::runtime_error&) {
      return std::nullopt;  // the caller counts it
    }
  }
  solution.min_det_f = organ_.body.minDetF(solution.state.u);
  return solution;
}

}  // namespace palpate::certify
