// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/surface_picture.h"

#include <algorithm>

#include "tools/program/numbers.h"
#include "tools/program/printed.h"
#include "tools/program/svg.h"

namespace palpate::picture {

namespace {

using program::printed;
using program::svgText;

// px
constexpr double kMargin = 24, kTop = 56, kLine = 22, kTallest = 560;
constexpr double kBarRoom = 110, kBarWidth = 18, kStepHeight = 26;

constexpr const char* kStyle =
    R"(.surface { fill: currentColor; stroke: currentColor; stroke-width: 0.9; stroke-linejoin: round; }
.mark { stroke: #1f2328; stroke-width: 1.2; }
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

double topOf(const SurfacePicture& picture) {
  return picture.title.empty() ? kMargin : kTop;
}

/// Of all that is coloured.
ColourSteps stepsOf(const SurfacePicture& picture) {
  std::vector<std::optional<double>> numbers = picture.surface.numbers;
  for (const Mark& mark : picture.marks) numbers.emplace_back(mark.number);
  return ColourSteps(numbers);
}

std::string colourBar(const SurfacePicture& picture, const ColourSteps& steps) {
  const double left = picture.width - kMargin - kBarRoom + 30;
  const double top = topOf(picture) + 28;
  std::string svg = svgText(picture.width - kMargin, top - 14, picture.bar_label, " text-anchor=\"end\"");
  for (std::size_t i = 0; i <= steps.count(); ++i) {
    const double y = top + kStepHeight * static_cast<double>(steps.count() - i);
    svg += svgText(left + kBarWidth + 6, y + 4, printed("%.6g", steps.end(i)));
    if (i == steps.count()) break;
    svg += printed("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n", left,
                   y - kStepHeight, kBarWidth, kStepHeight, steps.colour(i, 1.0).c_str());
  }
  return svg;
}

double barBottom(const SurfacePicture& picture, const ColourSteps& steps) {
  return topOf(picture) + 28 + kStepHeight * static_cast<double>(steps.count());
}

/// A round length, about a fifth of the picture.
std::string lengthBar(const Camera& camera, const Frame& frame, double y) {
  const double length = program::niceTicks(0.0, frame.width / camera.scale() / 5.0, 1)[1];
  const double px = length * camera.scale(), left = frame.left;
  return printed("<path class=\"line\" d=\"M%.1f %.1fv8h%.1fv-8\"/>\n", left, y - 8, px) +
         svgText(left + px + 8, y, printed("%.6g mm", 1e3 * length));
}

/// A line for each entry. @param[in,out] y  px, of the line above, then of the last one
std::string legend(const SurfacePicture& picture, double& y) {
  constexpr double kText = kMargin + 38;
  std::string svg;
  if (picture.cross) {
    y += kLine;
    svg += crossAt(kMargin + 14, y - 5) + svgText(kText, y, picture.cross_label);
  }
  for (const Inside& inside : picture.inside) {
    y += kLine;
    svg += rimmed(printed("M%.1f %.1fh28", kMargin, y - 5), " dashed") + svgText(kText, y, inside.name);
  }
  return svg;
}

std::string markAt(const Mark& mark, const Vec3& at, const ColourSteps& steps) {
  const std::string colour = steps.colour(steps.stepOf(mark.number), 1.0);
  if (mark.square)
    return printed("<rect class=\"mark\" fill=\"%s\" x=\"%.1f\" y=\"%.1f\" width=\"9\" height=\"9\"/>\n",
                   colour.c_str(), at.x() - 4.5, at.y() - 4.5);
  return printed("<circle class=\"mark\" fill=\"%s\" cx=\"%.1f\" cy=\"%.1f\" r=\"5\"/>\n", colour.c_str(),
                 at.x(), at.y());
}

/// What lies on the surface and in it.
std::string overlays(const SurfacePicture& picture, const Camera& camera, const ColourSteps& steps) {
  std::string svg;
  for (const Inside& part : picture.inside) {
    const std::string d = outlineOf(*part.surface, camera);
    if (!d.empty()) svg += rimmed(d, " dashed");
  }
  for (const Mark& mark : picture.marks)
    if (!isHidden(picture.surface, camera, mark.X)) svg += markAt(mark, camera.place(mark.X), steps);
  if (picture.cross && !isHidden(picture.surface, camera, *picture.cross)) {
    const Vec3 at = camera.place(*picture.cross);
    svg += crossAt(at.x(), at.y());
  }
  return svg;
}

}  // namespace

std::string SurfacePicture::svg() const {
  const ColourSteps steps = stepsOf(*this);
  const Frame frame{kMargin, topOf(*this), width - 2.0 * kMargin - kBarRoom, kTallest};
  const Camera camera(surface, frame);
  double line = std::max(camera.bottom(), barBottom(*this, steps)) + 36;
  std::string below = lengthBar(camera, frame, line);
  below += legend(*this, line);
  const double height = line + 16;
  std::string svg = program::svgStart(width, height, kStyle);
  if (!title.empty()) svg += svgText(kMargin, 28, title, " class=\"title\"");
  svg += "<g class=\"surface\">\n" + drawnSurface(surface, camera, steps) + "</g>\n";
  return svg + overlays(*this, camera, steps) + colourBar(*this, steps) + below + "</svg>\n";
}

}  // namespace palpate::picture
