// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/fit_plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/program/numbers.h"
#include "tools/program/printed.h"
#include "tools/program/svg.h"

namespace palpate::fit {

namespace {

using program::printed;
using program::svgText;

// px
constexpr double kWidth = 760, kHeight = 620, kLeft = 84, kRight = 20;
constexpr double kForceTop = 84, kForceBottom = 400, kResidualTop = 440, kResidualBottom = 564;

constexpr const char* kStyle = R"(.point { stroke: #c0262d; fill: #c0262d; } .beyond { fill: none; }
.curve { stroke: #2563a8; stroke-width: 1.8; fill: none; }
)";

/// Round numbers that cover a range, and where they are.
struct Axis {
  std::vector<double> ticks;
  double first, last;  // px
  [[nodiscard]] double px(double value) const {
    return first + (last - first) * (value - ticks.front()) / (ticks.back() - ticks.front());
  }
};

Axis axisOf(double low, double high, int count, double first, double last) {
  const double least = 1e-12 + 1e-9 * std::abs(high);  // of a range that shows
  if (high - low < least) low -= least, high += least;
  return {program::niceTicks(low, high, count), first, last};
}

struct Axes {
  Axis depth, force, residual;  // mm, N, mN
};

Axes axesOf(const Findings& found) {
  double shallow = 1e3 * found.estimate.offset.value, deep = shallow, low = 0.0, high = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < found.curve.points.size(); ++i) {
    const MeasuredPoint& point = found.curve.points[i];
    shallow = std::min(shallow, 1e3 * point.depth);
    deep = std::max(deep, 1e3 * point.depth);
    low = std::min({low, point.force, found.estimate.expected[i]});
    high = std::max({high, point.force, found.estimate.expected[i]});
    largest = std::max(largest, 1e3 * std::abs(found.estimate.residual[i]));
  }
  return {axisOf(shallow, deep, 8, kLeft, kWidth - kRight), axisOf(low, high, 6, kForceBottom, kForceTop),
          axisOf(-largest, largest, 4, kResidualBottom, kResidualTop)};
}

std::string rows(const Axis& y, const std::string& label) {
  std::string svg = svgText(kLeft, y.last - 10, label);
  for (const double tick : y.ticks)
    svg += printed("<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", kLeft, y.px(tick), kWidth - kRight) +
           svgText(kLeft - 8, y.px(tick) + 4, printed("%.6g", tick), " text-anchor=\"end\"");
  return svg;
}

std::string columns(const Axis& x) {
  std::string svg;
  for (const double tick : x.ticks)
    svg += printed("<path class=\"grid\" d=\"M%.1f %.1fV%.1fM%.1f %.1fV%.1f\"/>\n", x.px(tick), kForceTop,
                   kForceBottom, x.px(tick), kResidualTop, kResidualBottom) +
           svgText(x.px(tick), kResidualBottom + 20, printed("%.6g", tick), " text-anchor=\"middle\"");
  return svg + svgText(0.5 * (kLeft + kWidth - kRight), kHeight - 12, "depth, mm", " text-anchor=\"middle\"");
}

std::string curve(const Findings& found, const Axes& axes) {
  constexpr int kSteps = 240;
  std::string path;
  for (int step = 0; step <= kSteps; ++step) {
    const double mm =
        axes.depth.ticks.front() + (axes.depth.ticks.back() - axes.depth.ticks.front()) * step / kSteps;
    const double force =
        found.estimate.scale.value * found.press.at(1e-3 * mm - found.estimate.offset.value).force;
    if (force > axes.force.ticks.back()) break;
    path += printed("%s%.1f %.1f", step == 0 ? "M" : "L", axes.depth.px(mm), axes.force.px(force));
  }
  return "<path class=\"curve\" d=\"" + path + "\"/>\n" +
         printed("<path class=\"curve\" d=\"M%.1f %.1fH%.1f\"/>\n", kLeft, axes.residual.px(0.0),
                 kWidth - kRight);
}

std::string points(const Findings& found, const Axes& axes) {
  std::string svg;
  for (std::size_t i = 0; i < found.curve.points.size(); ++i) {
    const MeasuredPoint& point = found.curve.points[i];
    const bool beyond = found.press.at(point.depth - found.estimate.offset.value).beyond;
    for (const double y : {axes.force.px(point.force), axes.residual.px(1e3 * found.estimate.residual[i])})
      svg += printed("<circle class=\"point%s\" cx=\"%.1f\" cy=\"%.1f\" r=\"3\"/>\n", beyond ? " beyond" : "",
                     axes.depth.px(1e3 * point.depth), y);
  }
  return svg;
}

}  // namespace

std::string fitPlot(const std::string& title, const Findings& found) {
  const Axes axes = axesOf(found);
  const auto [low, high] = found.interval();
  return program::svgStart(kWidth, kHeight, kStyle) + svgText(kLeft, 28, title, " class=\"title\"") +
         svgText(kLeft, 48,
                 printed("E %.6g Pa, %.6g to %.6g Pa with %g %% confidence; hollow: beyond the domain",
                         found.E(), low, high, 100.0 * found.options.confidence)) +
         rows(axes.force, "force, N") + rows(axes.residual, "measured less fitted, mN") +
         columns(axes.depth) + curve(found, axes) + points(found, axes) + "</svg>\n";
}

}  // namespace palpate::fit
