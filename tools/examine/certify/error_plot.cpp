// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/error_plot.h"

#include <algorithm>
#include <cmath>

#include "tools/program/numbers.h"
#include "tools/program/printed.h"
#include "tools/program/svg.h"

namespace palpate::certify {

namespace {

using program::printed;
using program::svgText;

// px
constexpr double kWidth = 760, kHeight = 440, kLeft = 76, kRight = 20, kTop = 72, kBottom = 56;
constexpr double kLeast = 1e-6;  // of the errors that are told apart

constexpr const char* kStyle =
    R"(.force { stroke: #c0262d; fill: #c0262d; } .field { stroke: #2563a8; fill: #2563a8; } .beyond { fill: none; }
)";

std::string mark(double x, double y, bool force, bool beyond) {
  const std::string kind = printed("class=\"%s%s\"", force ? "force" : "field", beyond ? " beyond" : "");
  if (force) return printed("<circle %s cx=\"%.1f\" cy=\"%.1f\" r=\"4\"/>\n", kind.c_str(), x, y);
  return printed("<rect %s x=\"%.1f\" y=\"%.1f\" width=\"7\" height=\"7\"/>\n", kind.c_str(), x - 3.5,
                 y - 3.5);
}

/// abs(d) along x, errors by decades along y.
struct Axes {
  double longest{0.0};         // m
  int lowest{0}, highest{-2};  // decades
  [[nodiscard]] double x(double length) const { return kLeft + (kWidth - kLeft - kRight) * length / longest; }
  [[nodiscard]] double y(double error) const {
    const double part = (std::log10(std::max(error, kLeast)) - lowest) / (highest - lowest);
    return kHeight - kBottom - (kHeight - kTop - kBottom) * part;
  }
};

Axes axesOf(const std::vector<const Finding*>& findings) {
  Axes axes;
  double longest = 0.0;
  for (const Finding* f : findings) {
    longest = std::max(longest, f->touch.d.norm());
    for (const double error : {f->force_error, f->field_error}) {
      const double decade = std::log10(std::max(error, kLeast));
      axes.lowest = std::min(axes.lowest, static_cast<int>(std::floor(decade)));
      axes.highest = std::max(axes.highest, static_cast<int>(std::ceil(decade)));
    }
  }
  axes.longest = longest > 0.0 ? 1.05 * longest : 1e-3;
  axes.lowest = std::min(axes.lowest, axes.highest - 1);
  return axes;
}

std::string grid(const Axes& axes) {
  std::string svg;
  for (int decade = axes.lowest; decade <= axes.highest; ++decade) {
    const double y = axes.y(std::pow(10.0, decade));
    svg += printed("<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", kLeft, y, kWidth - kRight) +
           svgText(kLeft - 8, y + 4, printed("%g %%", std::pow(10.0, decade + 2)), " text-anchor=\"end\"");
  }
  for (const double mm : program::niceTicks(0.0, 1e3 * axes.longest, 6)) {
    const double x = axes.x(1e-3 * mm);
    if (x > kWidth - kRight) continue;
    svg += printed("<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", x, kTop, kHeight - kBottom) +
           svgText(x, kHeight - kBottom + 20, printed("%g", mm), " text-anchor=\"middle\"");
  }
  return svg +
         svgText(0.5 * (kLeft + kWidth - kRight), kHeight - 12, "length of d, mm", " text-anchor=\"middle\"");
}

std::string legend() {
  std::string svg;
  double x = kLeft;
  for (const bool beyond : {false, true})
    for (const bool force : {true, false}) {
      svg +=
          mark(x, 50, force, beyond) +
          svgText(x + 10, 54, std::string(force ? "force" : "field") + (beyond ? ", beyond the domain" : ""));
      x += beyond ? 190 : 80;
    }
  return svg;
}

}  // namespace

std::string errorPlot(const std::string& title, const std::vector<Finding>& findings) {
  std::vector<const Finding*> solved;
  for (const Finding& finding : findings)
    if (finding.outcome == Outcome::kWithin || finding.outcome == Outcome::kBeyond)
      solved.push_back(&finding);
  const Axes axes = axesOf(solved);
  std::string svg = program::svgStart(kWidth, kHeight, kStyle) +
                    svgText(kLeft, 28, title, " class=\"title\"") + legend() + grid(axes);
  for (const Finding* f : solved) {
    const double x = axes.x(f->touch.d.norm());
    const bool beyond = f->outcome == Outcome::kBeyond;
    svg += mark(x, axes.y(f->field_error), false, beyond) + mark(x, axes.y(f->force_error), true, beyond);
  }
  return svg + "</svg>\n";
}

}  // namespace palpate::certify
