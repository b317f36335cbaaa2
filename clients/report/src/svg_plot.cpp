// SPDX-License-Identifier: Apache-2.0
#include "palpate/report/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tools/program/numbers.h"
#include "tools/program/printed.h"
#include "tools/program/xml.h"

namespace palpate::report {
namespace {

constexpr double kWidth = 760, kHeight = 420;
constexpr double kLeft = 70, kRight = 20, kTop = 48, kBottom = 52;
constexpr double kFloor = 0.5;  // where a count of 0 sits on a logarithmic axis

std::string number(double value) {
  return program::printed("%.6g", value);
}

// Parts one after the other.
template <class... Parts>
std::string joined(const Parts&... parts) {
  std::string text;
  (text.append(parts), ...);
  return text;
}

// One axis: from its values to pixels.
struct Axis {
  double low, high;
  double at_low, at_high;  // px
  bool log;
  std::vector<double> ticks;

  [[nodiscard]] double px(double value) const {
    const auto place = [this](double v) {
      return log ? std::log10(std::max(v, std::numeric_limits<double>::min())) : v;
    };
    return at_low + (at_high - at_low) * (place(value) - place(low)) / (place(high) - place(low));
  }
};

// A logarithmic axis gets the powers of ten, and 2 and 5 times those when they are few.
std::vector<double> logTicks(double low, double high) {
  const bool few = std::log10(high / low) < 2.5;
  std::vector<double> ticks;
  for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10.0)
    for (const double step : {1.0, 2.0, 5.0})
      if ((few || step < 1.5) && decade * step >= low && decade * step <= high)
        ticks.push_back(decade * step);
  return ticks;
}

Axis makeAxis(double low, double high, double at_low, double at_high, bool log) {
  if (!(low < high)) {  // nothing or one value: some room around it
    if (log) return makeAxis(low > 0.0 ? low / 2.0 : 1.0, low > 0.0 ? low * 2.0 : 10.0, at_low, at_high, log);
    const double room = std::max(std::abs(low), 1.0);
    return makeAxis(low - room / 2.0, low + room / 2.0, at_low, at_high, log);
  }
  if (log) return {low, high, at_low, at_high, true, logTicks(low, high)};
  std::vector<double> ticks = program::niceTicks(low, high, 6);
  const double from = std::min(low, ticks.front());
  const double upto = std::max(high, ticks.back());
  return {from, upto, at_low, at_high, false, std::move(ticks)};
}

struct Range {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};
  void cover(double value) {
    if (!std::isfinite(value)) throw std::invalid_argument("a plot cannot show a number that is not finite");
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

Axis xAxis(const SvgPlot& plot) {
  Range range;
  for (const Series& series : plot.series) {
    for (const double x : series.x) range.cover(x);
    for (const double x : series.x_end) range.cover(x);
  }
  if (range.low > range.high) range = {1.0, 1.0};
  return makeAxis(range.low, range.high, kLeft, kWidth - kRight, plot.log_x);
}

Axis yAxis(const SvgPlot& plot) {
  Range range;
  for (const Series& series : plot.series)
    for (const double y : series.y) range.cover(y);
  if (range.low > range.high) range = {0.0, 1.0};
  if (plot.log_y) return makeAxis(kFloor, std::max(range.high * 1.3, 10.0), kHeight - kBottom, kTop, true);
  return makeAxis(std::min(range.low, 0.0), range.high, kHeight - kBottom, kTop, false);
}

std::string textAt(double x, double y, const char* anchor, const std::string& text,
                   const std::string& extra = {}) {
  return joined("<text x=\"", number(x), "\" y=\"", number(y), "\" text-anchor=\"", anchor, "\"", extra, ">",
                program::xmlEscaped(text), "</text>\n");
}

std::string lineAt(double x1, double y1, double x2, double y2, const std::string& style) {
  return joined("<line class=\"", style, "\" x1=\"", number(x1), "\" y1=\"", number(y1), "\" x2=\"",
                number(x2), "\" y2=\"", number(y2), "\"/>\n");
}

std::string frame(const SvgPlot& plot, const Axis& x, const Axis& y) {
  std::string svg;
  for (const double tick : x.ticks) {
    svg += lineAt(x.px(tick), kTop, x.px(tick), kHeight - kBottom, "grid");
    svg += textAt(x.px(tick), kHeight - kBottom + 18, "middle", number(tick));
  }
  for (const double tick : y.ticks) {
    svg += lineAt(kLeft, y.px(tick), kWidth - kRight, y.px(tick), "grid");
    svg += textAt(kLeft - 8, y.px(tick) + 4, "end", number(tick));
  }
  svg += lineAt(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom, "axis");
  svg += lineAt(kLeft, kTop, kLeft, kHeight - kBottom, "axis");
  svg += textAt(kWidth / 2, 24, "middle", plot.title, " class=\"title\"");
  svg += textAt((kLeft + kWidth - kRight) / 2, kHeight - 12, "middle", plot.x_label);
  const double middle = (kTop + kHeight - kBottom) / 2;
  const std::string turned = joined(" transform=\"rotate(-90 16 ", number(middle), ")\"");
  return svg + textAt(16, middle, "middle", plot.y_label, turned);
}

std::string curve(const Series& series, const Axis& x, const Axis& y, std::size_t color) {
  std::string points;
  for (std::size_t i = 0; i < series.x.size(); ++i)
    points += joined(i == 0 ? "" : " ", number(x.px(series.x[i])), ",", number(y.px(series.y[i])));
  return joined("<polyline class=\"curve c", std::to_string(color), "\" points=\"", points, "\"/>\n");
}

std::string bars(const Series& series, const Axis& x, const Axis& y, std::size_t color) {
  std::string svg;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const double top = y.px(std::max(series.y[i], y.low));
    const double bottom = kHeight - kBottom;
    if (top >= bottom) continue;
    const double left = x.px(series.x[i]);
    svg += joined("<rect class=\"bar c", std::to_string(color), "\" x=\"", number(left), "\" y=\"",
                  number(top), "\" width=\"", number(x.px(series.x_end[i]) - left), "\" height=\"",
                  number(bottom - top), "\"/>\n");
  }
  return svg;
}

std::string legend(const SvgPlot& plot) {
  std::string svg;
  for (std::size_t i = 0; i < plot.series.size() && plot.series.size() > 1; ++i) {
    const double at = kTop + 16 + 18 * static_cast<double>(i);
    const double left = kWidth - kRight - 150;
    svg += lineAt(left, at - 4, left + 24, at - 4, joined("curve c", std::to_string(i % 4)));
    svg += textAt(left + 30, at, "start", plot.series[i].name);
  }
  return svg;
}

// Colours that keep their contrast on white and on near-black; blue, orange, green and purple also differ in
// brightness for readers who do not tell hues apart.
constexpr const char* kStyle = R"(<style>
svg { background: #ffffff; color: #1f2328; }
text { font: 12px sans-serif; fill: currentColor; }
.title { font-size: 15px; font-weight: bold; }
.axis { stroke: currentColor; } .grid { stroke: currentColor; stroke-opacity: 0.15; }
.curve { fill: none; stroke-width: 1.6; } .bar { fill-opacity: 0.55; }
.c0 { stroke: #0969da; } .bar.c0 { fill: #0969da; } .c1 { stroke: #d4761c; } .bar.c1 { fill: #d4761c; }
.c2 { stroke: #1a7f37; } .bar.c2 { fill: #1a7f37; } .c3 { stroke: #8250df; } .bar.c3 { fill: #8250df; }
@media (prefers-color-scheme: dark) { svg { background: #0d1117; color: #e6edf3; }
.c0 { stroke: #58a6ff; } .bar.c0 { fill: #58a6ff; } .c1 { stroke: #f0a35e; } .bar.c1 { fill: #f0a35e; }
.c2 { stroke: #3fb950; } .bar.c2 { fill: #3fb950; } .c3 { stroke: #bc8cff; } .bar.c3 { fill: #bc8cff; } }
</style>
)";

void checkSizes(const SvgPlot& plot) {
  for (const Series& series : plot.series)
    if (series.x.size() != series.y.size() ||
        (!series.x_end.empty() && series.x_end.size() != series.x.size()))
      throw std::invalid_argument("series '" + series.name + "' has " + std::to_string(series.x.size()) +
                                  " x and " + std::to_string(series.y.size()) + " y");
}

}  // namespace

std::string SvgPlot::render() const {
  checkSizes(*this);
  const Axis x = xAxis(*this);
  const Axis y = yAxis(*this);
  std::string svg =
      joined("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", number(kWidth), "\" height=\"",
             number(kHeight), "\" viewBox=\"0 0 ", number(kWidth), " ", number(kHeight), "\">\n", kStyle);
  svg += frame(*this, x, y);
  for (std::size_t i = 0; i < series.size(); ++i)
    svg += series[i].x_end.empty() ? curve(series[i], x, y, i % 4) : bars(series[i], x, y, i % 4);
  return svg + legend(*this) + "</svg>\n";
}

}  // namespace palpate::report
