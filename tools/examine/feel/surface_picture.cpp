// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/surface_picture.h"

#include <array>

#include "tools/program/numbers.h"
#include "tools/program/printed.h"
#include "tools/program/svg.h"

namespace palpate::feel {

namespace {

using program::printed;
using program::svgText;

// px
constexpr double kWidth = 860, kMargin = 24, kTop = 56, kLine = 22;
constexpr double kBarRoom = 110, kBarWidth = 18, kStepHeight = 26;
constexpr Frame kFrame{kMargin, kTop, kWidth - 2.0 * kMargin - kBarRoom, 560};

constexpr const char* kStyle =
    R"(.surface { fill: currentColor; stroke: currentColor; stroke-width: 0.9; stroke-linejoin: round; }
.line { fill: none; stroke: currentColor; stroke-width: 1.5; }
.under { fill: none; stroke: #ffffff; stroke-width: 4; stroke-opacity: 0.8; }
.over { fill: none; stroke: #c0262d; stroke-width: 2; } .dashed { stroke-dasharray: 6 4; }
)";

/// With a light rim, so that it shows on all colours.
std::string rimmed(const std::string& d, const char* extra = "") {
  return "<path class=\"under\" d=\"" + d + "\"/>\n<path class=\"over" + extra + "\" d=\"" + d + "\"/>\n";
}

std::string crossAt(double x, double y) {
  return rimmed(printed("M%.1f %.1fh14M%.1f %.1fv14", x - 7, y, x, y - 7));
}

std::string colourBar(const SurfacePicture& picture, const ColourSteps& steps) {
  const double left = kWidth - kMargin - kBarRoom + 30;
  const double top = kTop + 28;
  std::string svg = svgText(left, top - 14, picture.bar_label);
  for (std::size_t i = 0; i <= steps.count(); ++i) {
    const double y = top + kStepHeight * static_cast<double>(steps.count() - i);
    svg += svgText(left + kBarWidth + 6, y + 4, printed("%.6g", steps.end(i)));
    if (i == steps.count()) break;
    svg += printed("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n", left,
                   y - kStepHeight, kBarWidth, kStepHeight, steps.colour(i, 1.0).c_str());
  }
  return svg;
}

double barBottom(const ColourSteps& steps) {
  return kTop + 28 + kStepHeight * static_cast<double>(steps.count());
}

/// A round length, about a fifth of the picture.
std::string lengthBar(const Camera& camera, double y) {
  const double length = program::niceTicks(0.0, kFrame.width / camera.scale() / 5.0, 1)[1];
  const double px = length * camera.scale(), left = kFrame.left;
  return printed("<path class=\"line\" d=\"M%.1f %.1fv8h%.1fv-8\"/>\n", left, y - 8, px) +
         svgText(left + px + 8, y, printed("%.6g mm", 1e3 * length));
}

std::string legend(const SurfacePicture& picture, double y) {
  constexpr double kLeft = kFrame.left + 330;
  std::string svg = crossAt(kLeft, y - 5) + svgText(kLeft + 24, y, picture.cross_label);
  for (const Inside& inside : picture.inside) {
    y += kLine;
    svg +=
        rimmed(printed("M%.1f %.1fh28", kLeft - 14, y - 5), " dashed") + svgText(kLeft + 24, y, inside.name);
  }
  return svg;
}

}  // namespace

std::string SurfacePicture::svg() const {
  const ColourSteps steps(surface.numbers);
  const Camera camera(surface, kFrame);
  const double below = std::max(camera.bottom(), barBottom(steps)) + 36;
  const double height = below + kLine * static_cast<double>(inside.size()) + 16;
  std::string svg =
      program::svgStart(kWidth, height, kStyle) + svgText(kMargin, 28, title, " class=\"title\"");
  svg += "<g class=\"surface\">\n" + drawnSurface(surface, camera, steps) + "</g>\n";
  for (const Inside& part : inside) {
    const std::string d = outlineOf(*part.surface, camera);
    if (!d.empty()) svg += rimmed(d, " dashed");
  }
  const Vec3 at = camera.place(cross);
  svg += crossAt(at.x(), at.y());
  return svg + colourBar(*this, steps) + lengthBar(camera, below) + legend(*this, below) + "</svg>\n";
}

}  // namespace palpate::feel
