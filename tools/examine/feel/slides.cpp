// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/slides.h"

#include <algorithm>
#include <cmath>

#include "core/contact/contact_solver.h"
#include "tools/examine/feel/player.h"

namespace palpate::feel {

namespace {

constexpr double kTick = 1e-3;  // s

/// The force of one tick, and its quasi-static limit.
struct Felt {
  Vec3 force;
  Vec3 settled;
  bool contact;
};

/// A copy of step()'s contact, to look ahead without changing it.
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

StepConfig configOf(const SlideOptions& options) {
  StepConfig config = bareContact(options.friction);
  if (options.coupling_stiffness > 0.0) config.coupling_stiffness = options.coupling_stiffness;
  return config;
}

/// Ticks in which the tip speeds up from rest, 2.5 m/s^2 at 50 mm/s: a hand that pressed does not turn on the spot.
constexpr double kStart = 20.0;

/// Steps of the path that the tip has gone after so many ticks.
double stepsAfter(double ticks) {
  return ticks < kStart ? ticks * ticks / (2.0 * kStart) : ticks - 0.5 * kStart;
}

/// Position of the tip at each tick: down from 0.5 mm above the start of the path, then along it.
struct Tips {
  std::vector<Vec3> down;
  std::vector<Vec3> along;
};

Tips tipsOf(const std::vector<PathPoint>& path, const SlideOptions& options) {
  constexpr double kAbove = 5e-4;  // m
  const double radius = StepConfig{}.tip_radius;
  const auto tip = [&](const PathPoint& p, double depth) {
    return Vec3(p.position + (radius - depth) * p.normal);
  };
  Tips tips;
  for (double depth = -kAbove; depth < options.depth; depth += options.speed * kTick)
    tips.down.push_back(tip(path[0], depth));
  const auto last = static_cast<double>(path.size() - 1);
  for (double tick = 0.0; stepsAfter(tick) <= last; ++tick) {
    const double steps = stepsAfter(tick), share = steps - std::floor(steps);
    const auto i = static_cast<std::size_t>(steps);
    const Vec3 here = tip(path[i], options.depth),
               next = tip(path[std::min(i + 1, path.size() - 1)], options.depth);
    tips.along.emplace_back(here + share * (next - here));
  }
  return tips;
}

std::vector<Felt> play(const MetaModel& model, const Tips& tips, const SlideOptions& options) {
  const StepConfig config = configOf(options);
  Player player(model, config);
  Shadow shadow(model, config);
  const auto to = [&](const Vec3& c) {
    const ToolResult& result = player.at(c);
    return Felt{forceOf(result), shadow.settledAt(c), result.state != 0};
  };
  for (const Vec3& c : tips.down) (void)to(c);
  std::vector<Felt> felt;
  for (const Vec3& c : tips.along) felt.push_back(to(c));
  return felt;
}

/// The largest step of the force on the same path at a tenth of the speed: a slope gives a tenth, a jump the
/// same.
double largestSlowStep(const MetaModel& model, const Tips& tips, const SlideOptions& options) {
  constexpr int kSlower = 10;
  Player player(model, configOf(options));
  for (const Vec3& c : tips.down) (void)player.at(c);
  Vec3 last = forceOf(player.at(tips.along.front()));
  double largest = 0.0;
  for (std::size_t i = 1; i < tips.along.size(); ++i)
    for (int part = 1; part <= kSlower; ++part) {
      const double share = static_cast<double>(part) / kSlower;
      const Vec3 force = forceOf(player.at(tips.along[i - 1] + share * (tips.along[i] - tips.along[i - 1])));
      largest = std::max(largest, (force - last).norm());
      last = force;
    }
  return largest;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

SlideResult slide(const MetaModel& model, const std::vector<PathPoint>& path, const SlideOptions& options) {
  constexpr double kOfForce = 0.01, kOfMedian = 3.0, kOfForceInLag = 1e-3;
  constexpr double kBuildUp = 3e-3;  // m
  const Tips tips = tipsOf(path, options);
  const std::vector<Felt> felt = play(model, tips, options);
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
    if (stepsAfter(static_cast<double>(i)) * options.speed * kTick > kBuildUp)
      result.largest_ratio_later = std::max(result.largest_ratio_later, ratio);
    result.largest_step = std::max(result.largest_step, steps[i - 1]);
    result.largest_lag = std::max(result.largest_lag, lag);
    result.releases += felt[i].contact ? 0 : 1;
    result.mean_force += size / static_cast<double>(felt.size() - 1);
  }
  if (result.largest_ratio > 1.0) result.largest_slow_step = largestSlowStep(model, tips, options);
  result.ticks = static_cast<int>(felt.size());
  return result;
}

std::vector<SlideResult> slides(const MetaModel& model, const SlideOptions& options) {
  const double height = StepConfig{}.tip_radius - options.depth;
  std::mt19937 random(options.seed);
  std::vector<SlideResult> results;
  while (static_cast<int>(results.size()) < options.paths) {
    const auto path = randomPath(model, height, options.speed * kTick, options.length, random);
    if (path) results.push_back(slide(model, *path, options));
  }
  return results;
}

}  // namespace palpate::feel
