// SPDX-License-Identifier: Apache-2.0
#include "palpate/feel/slides.h"

#include <algorithm>

#include "palpate/core/contact_solver.h"
#include "palpate/feel/player.h"

namespace palpate::feel {

namespace {

constexpr double kTick = 1e-3;  // s

/// The force of one tick and what it would come to be.
struct Felt {
  Vec3 force;
  Vec3 settled;
  bool contact;
};

/// The contact of step() once more, to look ahead without moving it.
class Shadow {
 public:
  Shadow(const MetaModel& model, const StepConfig& config)
      : model_(model),
        solver_(config.tip_radius),
        law_{config.friction, 1.0 / config.coupling_stiffness, 1.0} {}

  Vec3 settledAt(const Vec3& c) {
    constexpr int kLonger = 20;
    solver_.update(model_, law_, c, contact_);
    Contact ahead = contact_;
    for (int i = 0; i < kLonger; ++i) solver_.update(model_, law_, c, ahead);
    return -ahead.coupled.response.force;
  }

 private:
  const MetaModel& model_;
  ContactSolver solver_;
  ContactLaw law_;
  Contact contact_;
};

std::vector<Felt> play(const MetaModel& model, const std::vector<PathPoint>& path,
                       const SlideOptions& options) {
  StepConfig config = bareContact(options.friction);
  if (options.coupling_stiffness > 0.0) config.coupling_stiffness = options.coupling_stiffness;
  Player player(model, config);
  Shadow shadow(model, config);
  const auto to = [&](const PathPoint& point, double depth) {
    const Vec3 c = point.position + (config.tip_radius - depth) * point.normal;
    const ToolResult& result = player.at(c);
    return Felt{forceOf(result), shadow.settledAt(c), result.state != 0};
  };
  for (double depth = -5e-4; depth < options.depth; depth += options.speed * kTick) (void)to(path[0], depth);
  std::vector<Felt> felt;
  for (const PathPoint& point : path) felt.push_back(to(point, options.depth));
  return felt;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

SlideResult slide(const MetaModel& model, const std::vector<PathPoint>& path, const SlideOptions& options) {
  constexpr double kOfForce = 0.01, kOfMedian = 3.0, kOfForceInLag = 1e-3;
  const std::vector<Felt> felt = play(model, path, options);
  SlideResult result;
  std::vector<double> steps;
  for (std::size_t i = 1; i < felt.size(); ++i) steps.push_back((felt[i].force - felt[i - 1].force).norm());
  result.median_step = median(steps);
  for (std::size_t i = 1; i < felt.size(); ++i) {
    const double size = std::max(felt[i].force.norm(), felt[i - 1].force.norm());
    const double ratio = steps[i - 1] / (kOfMedian * result.median_step + kOfForce * size);
    const double lag = (felt[i].force - felt[i].settled).norm() /
                       ((felt[i].settled - felt[i - 1].settled).norm() + kOfForceInLag * size);
    if (ratio > result.largest_ratio) result.worst = i;
    result.largest_ratio = std::max(result.largest_ratio, ratio);
    result.largest_step = std::max(result.largest_step, steps[i - 1]);
    result.largest_lag = std::max(result.largest_lag, lag);
    result.releases += felt[i].contact ? 0 : 1;
    result.mean_force += size / static_cast<double>(felt.size() - 1);
  }
  result.ticks = static_cast<int>(felt.size());
  return result;
}

std::vector<SlideResult> slides(const MetaModel& model, const SlideOptions& options) {
  std::mt19937 random(options.seed);
  std::vector<SlideResult> results;
  while (static_cast<int>(results.size()) < options.paths) {
    const auto path = randomPath(model, options.speed * kTick, options.length, random);
    if (path) results.push_back(slide(model, *path, options));
  }
  return results;
}

}  // namespace palpate::feel
