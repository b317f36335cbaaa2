// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/error_plot.h"

#include <algorithm>
#include <cmath>

namespace palpate::certify {

namespace {

using program::Look;
using program::Series;

constexpr double kLeast = 1e-4;  // per cent, of the errors that are told apart

Series marksOf(const std::vector<Finding>& findings, Outcome outcome, double Finding::*error) {
  const bool force = error == &Finding::force_error, beyond = outcome == Outcome::kBeyond;
  Series series;
  series.name = std::string(force ? "force" : "field") + (beyond ? ", beyond the domain" : "");
  series.look = force ? (beyond ? Look::kRings : Look::kDiscs) : (beyond ? Look::kFrames : Look::kSquares);
  series.colour = force ? 1 : 0;
  for (const Finding& finding : findings)
    if (finding.outcome == outcome) {
      series.x.push_back(1e3 * finding.touch.d.norm());
      series.y.push_back(100.0 * finding.*error);
    }
  return series;
}

}  // namespace

program::SvgPlot errorPlot(const std::vector<Finding>& findings) {
  program::SvgPlot plot;
  plot.x_label = "length of d / mm";
  plot.y_label = "error / %";
  plot.log_y = true;
  for (const Outcome outcome : {Outcome::kWithin, Outcome::kBeyond})
    for (double Finding::*const error : {&Finding::force_error, &Finding::field_error})
      plot.series.push_back(marksOf(findings, outcome, error));
  double least = 0.1;
  for (const Series& series : plot.series)
    for (const double error : series.y) least = std::min(least, std::max(error, kLeast));
  plot.log_floor = std::pow(10.0, std::floor(std::log10(least)));
  return plot;
}

}  // namespace palpate::certify
