// SPDX-License-Identifier: Apache-2.0
#include "tools/program/svg_plot.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

#include "tools/program/printed.h"
#include "tools/program/spread.h"
#include "tools/program/svg_axis.h"
#include "tools/program/xml.h"

namespace palpate::program {
namespace {

constexpr double kHeight = 420;
constexpr double kLeft = 70, kRight = 20, kBottom = 52;
constexpr double kRow = 18;     // of the legend
constexpr double kGlyph = 7.5;  // px, a wide guess of a letter's width
constexpr double kLeader = 22;  // px, from the frame to a curve's name

std::string number(double value) {
  return printed("%.6g", value);
}

// Parts one after the other.
template <class... Parts>
std::string joined(const Parts&... parts) {
  std::string text;
  (text.append(parts), ...);
  return text;
}

bool isMarks(const Series& series) {
  return series.look != Look::kLine && series.look != Look::kDashed;
}

// What has an end to put its name at.
bool isCurve(const Series& series) {
  return !series.x.empty() && series.x_end.empty() && series.y_end.empty() && !isMarks(series);
}

double widthOf(const std::string& name) {
  return kGlyph * static_cast<double>(name.size());
}

// Of the names beside the curves; 0 where one curve is alone, or the names leave the plot too little or find no room.
double columnOf(const SvgPlot& plot) {
  double widest = 0.0;
  std::size_t curves = 0;
  for (const Series& series : plot.series) {
    if (!isCurve(series)) continue;
    widest = std::max(widest, kLeader + widthOf(series.name));
    ++curves;
  }
  const bool fits = widest <= 0.35 * plot.width && kRow * static_cast<double>(curves) <= 0.6 * kHeight;
  return plot.series.size() > 1 && fits ? widest : 0.0;
}

/// Where the numbers are drawn, px; above it the legend, and right of it the names of curves.
struct Room {
  double right, top, bottom{kHeight - kBottom};
  bool names_beside{false};
  std::vector<std::optional<std::array<double, 2>>>
      legend{};  ///< left end and base line of each entry that is there
};

Room roomOf(const SvgPlot& plot) {
  const double column = columnOf(plot);
  Room room{plot.width - kRight - column, plot.title.empty() ? 16.0 : 40.0};
  room.names_beside = column > 0.0;
  double left = plot.width;  // the first entry begins a row
  for (const Series& series : plot.series) {
    room.legend.emplace_back();
    if (plot.series.size() < 2 || (room.names_beside && isCurve(series))) continue;
    const double width = 44.0 + widthOf(series.name);
    if (left + width > plot.width - kRight) {
      left = kLeft;
      room.top += kRow;
    }
    room.legend.back() = {left, room.top - 6.0};
    left += width;
  }
  room.top += 8.0;
  return room;
}

Axis xAxis(const SvgPlot& plot, const Room& room) {
  Range range;
  for (const Series& series : plot.series) {
    for (const double x : series.x) range.cover(x);
    for (const double x : series.x_end) range.cover(x);
  }
  if (range.low > range.high) range = {1.0, 1.0};
  return makeAxis(range.low, range.high, kLeft, room.right, plot.log_x);
}

Axis yAxis(const SvgPlot& plot, const Room& room) {
  Range range;
  for (const Series& series : plot.series) {
    for (const double y : series.y) range.cover(y);
    for (const double y : series.y_end) range.cover(y);
  }
  if (range.low > range.high) range = {0.0, 1.0};
  if (plot.log_y)
    return makeAxis(plot.log_floor, std::max(range.high * 1.3, 20.0 * plot.log_floor), room.bottom, room.top,
                    true);
  return makeAxis(std::min(range.low, 0.0), range.high, room.bottom, room.top, false);
}

std::string textAt(double x, double y, const char* anchor, const std::string& text,
                   const std::string& extra = {}) {
  return joined("<text x=\"", number(x), "\" y=\"", number(y), "\" text-anchor=\"", anchor, "\"", extra, ">",
                xmlEscaped(text), "</text>\n");
}

std::string lineAt(double x1, double y1, double x2, double y2, const std::string& style) {
  return joined("<line class=\"", style, "\" x1=\"", number(x1), "\" y1=\"", number(y1), "\" x2=\"",
                number(x2), "\" y2=\"", number(y2), "\"/>\n");
}

std::string colourOf(const SvgPlot& plot, const Series& series) {
  const auto place = static_cast<std::size_t>(&series - plot.series.data());
  return joined("c", std::to_string(series.colour.value_or(place) % 4));
}

std::string frame(const SvgPlot& plot, const Room& room, const Axis& x, const Axis& y) {
  std::string svg;
  for (const double tick : x.ticks) {
    svg += lineAt(x.px(tick), room.top, x.px(tick), room.bottom, "grid");
    svg += textAt(x.px(tick), room.bottom + 18, "middle", number(tick));
  }
  for (const double tick : y.ticks) {
    svg += lineAt(kLeft, y.px(tick), room.right, y.px(tick), "grid");
    svg += textAt(kLeft - 8, y.px(tick) + 4, "end", number(tick));
  }
  svg += lineAt(kLeft, room.bottom, room.right, room.bottom, "axis");
  svg += lineAt(kLeft, room.top, kLeft, room.bottom, "axis");
  if (!plot.title.empty()) svg += textAt(plot.width / 2, 24, "middle", plot.title, " class=\"title\"");
  svg += textAt((kLeft + room.right) / 2, kHeight - 12, "middle", plot.x_label);
  const double middle = (room.top + room.bottom) / 2;
  const std::string turned = joined(" transform=\"rotate(-90 16 ", number(middle), ")\"");
  return svg + textAt(16, middle, "middle", plot.y_label, turned);
}

std::string pointAt(double x, double y) {
  return joined(number(x), ",", number(y));
}

std::string curve(const Series& series, const Axis& x, const Axis& y, const std::string& colour) {
  std::string points;
  for (std::size_t i = 0; i < series.x.size(); ++i)
    points += joined(i == 0 ? "" : " ", pointAt(x.px(series.x[i]), y.px(std::max(series.y[i], y.low))));
  return joined("<polyline class=\"curve ", colour, series.look == Look::kDashed ? " dashed" : "",
                "\" points=\"", points, "\"/>\n");
}

std::string markAt(double x, double y, Look look, const std::string& colour) {
  const bool hollow = look == Look::kRings || look == Look::kFrames;
  const std::string begin = joined(" class=\"mark ", colour, hollow ? " hollow" : "", "\" ");
  if (look == Look::kDiscs || look == Look::kRings)
    return joined("<circle", begin, "cx=\"", number(x), "\" cy=\"", number(y), "\" r=\"4\"/>\n");
  return joined("<rect", begin, "x=\"", number(x - 3.5), "\" y=\"", number(y - 3.5),
                "\" width=\"7\" height=\"7\"/>\n");
}

std::string marks(const Series& series, const Axis& x, const Axis& y, const std::string& colour) {
  std::string svg;
  for (std::size_t i = 0; i < series.x.size(); ++i)
    svg += markAt(x.px(series.x[i]), y.px(std::max(series.y[i], y.low)), series.look, colour);
  return svg;
}

std::string band(const Series& series, const Axis& x, const Axis& y, const std::string& colour) {
  std::string points;
  for (std::size_t i = 0; i < series.x.size(); ++i)
    points += pointAt(x.px(series.x[i]), y.px(series.y[i])) + ' ';
  for (std::size_t i = series.x.size(); i-- > 0;)
    points += pointAt(x.px(series.x[i]), y.px(series.y_end[i])) + ' ';
  return joined("<polygon class=\"band ", colour, "\" points=\"", points, "\"/>\n");
}

std::string bars(const Series& series, const Axis& x, const Axis& y, const std::string& colour) {
  std::string svg;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const double top = y.px(std::max(series.y[i], y.low));
    const double bottom = y.at_low;
    if (top >= bottom) continue;
    const double left = x.px(series.x[i]);
    svg +=
        joined("<rect class=\"bar ", colour, "\" x=\"", number(left), "\" y=\"", number(top), "\" width=\"",
               number(x.px(series.x_end[i]) - left), "\" height=\"", number(bottom - top), "\"/>\n");
  }
  return svg;
}

std::string drawn(const Series& series, const Axis& x, const Axis& y, const std::string& colour) {
  if (!series.x_end.empty()) return bars(series, x, y, colour);
  if (!series.y_end.empty()) return band(series, x, y, colour);
  return isMarks(series) ? marks(series, x, y, colour) : curve(series, x, y, colour);
}

std::string legendEntry(const Series& series, double left, double base, const std::string& colour) {
  const std::string text = textAt(left + 30, base, "start", series.name);
  if (!series.y_end.empty())
    return joined("<rect class=\"band ", colour, "\" x=\"", number(left), "\" y=\"", number(base - 10),
                  "\" width=\"24\" height=\"12\"/>\n") +
           text;
  if (isMarks(series)) return markAt(left + 12, base - 4, series.look, colour) + text;
  const char* const dashed = series.look == Look::kDashed ? " dashed" : "";
  return lineAt(left, base - 4, left + 24, base - 4, joined("curve ", colour, dashed)) + text;
}

// The curves' names right of the frame, as high as the curves end but none over another, each with a line to its curve.
std::string namesBeside(const SvgPlot& plot, const Room& room, const Axis& x, const Axis& y) {
  std::vector<const Series*> curves;
  std::vector<double> ends;
  for (const Series& series : plot.series) {
    if (!isCurve(series)) continue;
    curves.push_back(&series);
    ends.push_back(y.px(std::max(series.y.back(), y.low)));
  }
  const std::vector<double> places = spread(ends, room.top, room.bottom, kRow);
  std::string svg;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string colour = colourOf(plot, *curves[i]);
    svg += lineAt(x.px(curves[i]->x.back()), ends[i], room.right + kLeader - 4, places[i],
                  joined("leader ", colour)) +
           textAt(room.right + kLeader, places[i] + 4, "start", curves[i]->name);
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
.curve { fill: none; stroke: currentColor; stroke-width: 1.6; } .dashed { stroke-dasharray: 5 4; }
.leader { stroke: currentColor; stroke-opacity: 0.6; }
.bar { fill: currentColor; stroke: currentColor; fill-opacity: 0.55; } .band { fill: currentColor; fill-opacity: 0.2; }
.mark { fill: currentColor; stroke: currentColor; } .hollow { fill: none; stroke-width: 1.4; }
.c0 { color: #0969da; } .c1 { color: #d4761c; } .c2 { color: #1a7f37; } .c3 { color: #8250df; }
@media (prefers-color-scheme: dark) { svg { background: #0d1117; color: #e6edf3; }
.c0 { color: #58a6ff; } .c1 { color: #f0a35e; } .c2 { color: #3fb950; } .c3 { color: #bc8cff; } }
</style>
)";

void checkSizes(const SvgPlot& plot) {
  for (const Series& series : plot.series) {
    const auto fits = [&](const std::vector<double>& end) {
      return end.empty() || end.size() == series.x.size();
    };
    if (series.x.size() != series.y.size() || !fits(series.x_end) || !fits(series.y_end))
      throw std::invalid_argument("series '" + series.name + "' has " + std::to_string(series.x.size()) +
                                  " x and " + std::to_string(series.y.size()) + " y");
  }
}

}  // namespace

std::string SvgPlot::render() const {
  checkSizes(*this);
  const Room room = roomOf(*this);
  const Axis x = xAxis(*this, room), y = yAxis(*this, room);
  std::string svg =
      joined("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", number(width), "\" height=\"",
             number(kHeight), "\" viewBox=\"0 0 ", number(width), " ", number(kHeight), "\">\n", kStyle);
  svg += frame(*this, room, x, y);
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::string colour = colourOf(*this, series[i]);
    svg += drawn(series[i], x, y, colour);
    if (const auto& at = room.legend[i]) svg += legendEntry(series[i], (*at)[0], (*at)[1], colour);
  }
  if (room.names_beside) svg += namesBeside(*this, room, x, y);
  return svg + "</svg>\n";
}

}  // namespace palpate::program
