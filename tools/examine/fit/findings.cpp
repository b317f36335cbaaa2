// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/findings.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tools/examine/fit/sign_runs.h"

namespace palpate::fit {

std::array<double, 2> Findings::interval() const {
  const double half = estimate.scale.halfWidth(), unit = model.attributes().E;
  return {unit * std::max(estimate.scale.value - half, 0.0), unit * (estimate.scale.value + half)};
}

std::array<double, 2> Findings::offsetInterval() const {
  const double half = estimate.offset.halfWidth();
  return {estimate.offset.value - half, estimate.offset.value + half};
}

double Findings::largestForce() const {
  double largest = 0.0;
  for (const MeasuredPoint& point : curve.points) largest = std::max(largest, std::abs(point.force));
  return largest;
}

double Findings::rmsResidual() const {
  double squares = 0.0;
  for (const double r : estimate.residual) squares += r * r;
  return std::sqrt(squares / static_cast<double>(estimate.residual.size()));
}

std::optional<double> Findings::rSquared() const {
  const auto [least, most] =
      std::minmax_element(curve.points.begin(), curve.points.end(),
                          [](const MeasuredPoint& a, const MeasuredPoint& b) { return a.force < b.force; });
  if (!(least->force < most->force)) return {};
  const auto n = static_cast<double>(curve.points.size());
  double sum = 0.0, squares = 0.0;
  for (const MeasuredPoint& point : curve.points) sum += point.force;
  for (const MeasuredPoint& point : curve.points)
    squares += (point.force - sum / n) * (point.force - sum / n);
  return 1.0 - n * rmsResidual() * rmsResidual() / squares;
}

std::optional<double> Findings::runsProbability() const {
  std::vector<std::size_t> order(curve.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
    return curve.points[a].depth < curve.points[b].depth;
  });
  std::vector<double> residuals;
  for (const std::size_t i : order)
    if (curve.points[i].depth > estimate.offset.value) residuals.push_back(estimate.residual[i]);
  return probabilityOfRuns(residuals);
}

bool Findings::isOfAnotherForm() const {
  constexpr double kRare = 0.01;
  const auto probability = runsProbability();
  return probability && *probability < kRare && rmsResidual() > options.model.share * largestForce();
}

}  // namespace palpate::fit
