// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace palpate::report {

/// One curve of a plot, or one set of bars.
struct Series {
  std::string name;
  std::vector<double> x;  ///< as many as y; for bars the left edges
  std::vector<double> y;
  std::vector<double> x_end;  ///< bars: the right edges; empty: a curve
};

/// A plot with axes, ticks, labels and a legend, as one self-contained SVG that reads on light and on dark
/// ground.
struct SvgPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool log_x{false};  ///< x above 0 then
  bool log_y{false};  ///< counts: 0 sits at the bottom, below 1
  std::vector<Series> series;

  /// @throw std::invalid_argument when a series' sizes differ or a number is not finite
  [[nodiscard]] std::string render() const;
};

}  // namespace palpate::report
