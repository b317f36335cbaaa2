// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/pair_examination.h"

#include <algorithm>
#include <span>

#include "tools/examine/certify/quantile_bound.h"
#include "tools/examine/query/together.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"

namespace palpate::certify {

namespace {

constexpr std::size_t kMostDraws = 20;  // times pairs

std::vector<PairFinding> draw(const MetaModel& model, TouchSampler& touches, std::size_t missing,
                              std::size_t most) {
  const double a = model.attributes().patch_radius;
  std::vector<PairFinding> drawn;
  for (std::size_t within = 0; within < missing && drawn.size() < most;) {
    PairFinding pair;
    pair.touches = touches.nextPair(kNearestPair * a, kFarthestPair * a);
    pair.distance = (pair.touches[1].position - pair.touches[0].position).norm();
    pair.flagged = std::any_of(pair.touches.begin(), pair.touches.end(),
                               [&](const Touch& touch) { return isBeyond(model, touch); });
    if (!pair.flagged) ++within;
    drawn.push_back(pair);
  }
  return drawn;
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
  const std::size_t wanted = 2 * extent.samples;
  ReferenceSolver reference(organ, model.attributes().patch_radius, extent.threads);
  std::vector<PairFinding> all;
  while (true) {
    const auto solved = static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [](const PairFinding& pair) { return pair.solved; }));
    const std::size_t left = kMostDraws * wanted - all.size();
    if (solved == wanted || left == 0) return all;
    std::vector<PairFinding> drawn = draw(model, touches, wanted - solved, left);
    std::vector<PairFinding*> within;
    for (PairFinding& pair : drawn)
      if (!pair.flagged) within.push_back(&pair);
    solvePairs(model, organ, reference, travel, extent.threads, within);
    all.insert(all.end(), drawn.begin(), drawn.end());
  }
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
