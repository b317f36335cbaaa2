// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace palpate::program {

/// How a series is drawn that has neither x_end nor y_end.
enum class Look { kLine, kDashed, kDiscs, kRings, kSquares, kFrames };

/// One curve of a plot, or one set of bars or marks, or a band.
struct Series {
  std::string name;
  std::vector<double> x;  ///< as many as y; for bars the left edges
  std::vector<double> y;
  std::vector<double> x_end;    ///< bars: the right edges; else empty
  std::vector<double> y_end{};  ///< a band from y to these; else empty
  Look look{Look::kLine};
  std::optional<std::size_t> colour{};  ///< 0 to 3; its place among the series unless given
};

/// A plot with axes, ticks, labels and a legend, as one self-contained SVG that reads on light and on dark
/// ground.
struct SvgPlot {
  std::string title;  ///< may be empty
  std::string x_label;
  std::string y_label;
  bool log_x{false};      ///< x above 0 then
  bool log_y{false};      ///< what is below log_floor sits at the bottom then
  double log_floor{0.5};  ///< > 0; the default is for counts
  double width{760.0};    ///< px; narrow ones are read on a phone
  std::vector<Series> series;

  /// @throw std::invalid_argument when a series' sizes differ or a number is not finite
  [[nodiscard]] std::string render() const;
};

}  // namespace palpate::program
