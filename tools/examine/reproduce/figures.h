// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace palpate::reproduce {

/// One line of a chart.
struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;
  bool dashed{false};
  bool marks{true};
  bool lines{true};
};

/// A plot of curves. A logarithmic axis leaves out points that are not positive.
struct Chart {
  std::string title, x_label, y_label;
  bool log_x{false}, log_y{false};
  std::vector<Curve> curves;
};

/// A surface of triangles in the colours of a value at its nodes, or plain with its edges.
struct SurfacePanel {
  std::string title;
  std::vector<Eigen::Vector3d> positions;              ///< m
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< into positions
  std::vector<double> values;                          ///< one for each position; empty: plain
};

struct SurfaceFigure {
  std::string title;
  std::vector<SurfacePanel> panels;
  int columns{3};
  double elevation{60}, azimuth{30};  ///< of the view, degrees
  double zoom{1.6};
  bool diverging{true};      ///< colours symmetric about zero; otherwise from the least value to the largest
  std::string colour_label;  ///< empty: no colour scale
};

/// Draws with gnuplot, an external program: .svg or .png by the extension.
/// @return false, after one line on standard error, when gnuplot is missing or fails; then there is no file
bool drawChart(const std::filesystem::path& image, const Chart& chart);
bool drawSurfaces(const std::filesystem::path& image, const SurfaceFigure& figure);

}  // namespace palpate::reproduce
