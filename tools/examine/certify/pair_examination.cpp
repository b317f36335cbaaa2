// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/pair_examination.h"

#include <algorithm>
#include <span>

#include "tools/examine/certify/draws.h"
#include "tools/examine/certify/quantile_bound.h"
#include "tools/examine/query/together.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"

namespace palpate::certify {

namespace {

PairFinding drawPair(const MetaModel& model, TouchSampler& touches) {
  const double a = model.attributes().patch_radius;
  PairFinding pair;
  pair.touches = touches.nextPair(kNearestPair * a, kFarthestPair * a);
  pair.distance = (pair.touches[1].position - pair.touches[0].position).norm();
  pair.flagged = std::any_of(pair.touches.begin(), pair.touches.end(),
                             [&](const Touch& touch) { return isBeyond(model, touch); });
  return pair;
}

/// NaN is larger than any number.
double larger(double a, double b) {
  return b <= a ? a : b;
}

void comparePair(const MetaModel& model, const query::Organ& organ, const query::FullSolution& truth,
                 double travel, PairFinding& pair) {
  std::vector<query::Touch> touches;
  double longest = 0.0;
  for (const Touch& touch : pair.touches) {
    touches.push_back({{touch.s, touch.position, 0}, touch.d});
    longest = std::max(longest, touch.d.norm());
  }
  const query::JointAnswer answer = query::askTogether(model, touches);
  for (std::size_t i = 0; i < touches.size(); ++i)
    pair.force_error =
        larger(pair.force_error, forceError(model, pair.touches[i], answer.tools[i].together.response.force,
                                            truth.state.forces[i], travel));
  pair.field_error = fieldError(answer.field, truth, organ, longest);
  requireFinite(pair.touches[0], pair.force_error, pair.field_error);
  pair.min_det_f = truth.min_det_f;
  pair.solved = true;
}

void solvePairs(const MetaModel& model, const query::Organ& organ, ReferenceSolver& reference, double travel,
                int threads, std::span<PairFinding* const> pairs) {
  constexpr std::size_t kAtOnce = 48;
  solver::Progress progress("full solutions of two tools", pairs.size());
  for (; !pairs.empty(); pairs = pairs.subspan(std::min(kAtOnce, pairs.size()))) {
    const auto batch = pairs.first(std::min(kAtOnce, pairs.size()));
    std::vector<Touch> touches;
    for (const PairFinding* pair : batch)
      touches.insert(touches.end(), pair->touches.begin(), pair->touches.end());
    const std::vector<Eigen::VectorXd> starts = reference.starts(touches);
    solver::parallelFor(threads, batch.size(), [&](int thread, std::size_t i) {
      const auto truth = reference.solve(batch[i]->touches, starts[2 * i] + starts[2 * i + 1], thread);
      if (truth) comparePair(model, organ, *truth, travel, *batch[i]);
      progress.advance();
    });
  }
}

}  // namespace

std::vector<PairFinding> examinePairs(const MetaModel& model, const query::Organ& organ,
                                      TouchSampler& touches, double travel, const Extent& extent) {
  ReferenceSolver reference(organ, model.attributes().patch_radius, extent.threads);
  const auto solve = [&](std::vector<PairFinding>& drawn) {
    std::vector<PairFinding*> within;
    for (PairFinding& pair : drawn)
      if (!pair.flagged) within.push_back(&pair);
    solvePairs(model, organ, reference, travel, extent.threads, within);
  };
  return drawAndSolve(
      2 * extent.samples, [&] { return drawPair(model, touches); }, solve,
      [](const PairFinding& pair) { return pair.solved; });
}

std::optional<double> leastDistance(std::span<const PairFinding> solved, double patch_radius, double error) {
  std::optional<double> least;
  for (const double radii : {kFarthestPair, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, kNearestPair}) {
    const double distance = radii * patch_radius;
    std::vector<double> force, field;
    for (const PairFinding& pair : solved)
      if (pair.distance >= distance) {
        force.push_back(pair.force_error);
        field.push_back(pair.field_error);
      }
    if (!rankOfBound(force.size())) continue;
    if (*statisticsOf(force).bound_95_95 > error || *statisticsOf(field).bound_95_95 > error) return least;
    least = distance;
  }
  return least;
}

}  // namespace palpate::certify
