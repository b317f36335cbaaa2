// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/make/organ/preview.h"
#include "tools/picture/drawn_surface.h"
#include "tools/program/numbers.h"
#include "tools/program/printed.h"
#include "tools/program/svg.h"

namespace palpate::organ {
namespace {

using program::printed;
using program::svgText;

// px
constexpr double kMargin = 24, kTop = 56, kCell = 280, kGap = 24, kCaption = 22;

struct View {
  const char* name;
  Eigen::Vector3d towards_eye;
};
const View kViews[] = {{"from -y", {0, -1, 0}}, {"from +y", {0, 1, 0}}, {"from +z", {0, 0, 1}},
                       {"from -x", {-1, 0, 0}}, {"from +x", {1, 0, 0}}, {"from -z", {0, 0, -1}}};

struct Class {
  const char* name;
  int red, green, blue;
};
// Of unlike brightness, so that readers who do not tell hues apart tell them, too.
constexpr Class kClasses[] = {
    {"held", 122, 28, 46}, {"can be touched", 127, 205, 187}, {"neither", 176, 176, 176}};

std::string colourOf(const Class& c, double light) {
  const auto byte = [&](int full) { return static_cast<unsigned>(std::lround(light * full)); };
  return printed("#%02x%02x%02x", byte(c.red), byte(c.green), byte(c.blue));
}

// 0 held, 1 can be touched, 2 neither, for each triangle: all its nodes are.
std::vector<std::size_t> classesOf(const Preview& preview) {
  std::vector<std::size_t> of_node(preview.mesh.nodes.size(), 2);
  const auto mark = [&](const char* group, std::size_t number) {
    const auto found = preview.mesh.groups.find(group);
    if (found == preview.mesh.groups.end()) return;
    for (const auto node : found->second) of_node[static_cast<std::size_t>(node)] = number;
  };
  mark("accessible", 1);
  mark("fixed", 0);
  std::vector<std::size_t> classes;
  for (const auto& t : preview.boundary.triangles) {
    const auto at = [&](std::size_t k) {
      return of_node[static_cast<std::size_t>(preview.boundary.nodes[static_cast<std::size_t>(t[k])])];
    };
    classes.push_back(at(0) == at(1) && at(1) == at(2) ? at(0) : 2);
  }
  return classes;
}

struct Drawn {
  double depth;
  std::string path;
};

/// The triangles that the eye sees, the farthest first.
std::string drawn(const Preview& preview, const std::vector<std::size_t>& classes,
                  const picture::Camera& camera) {
  std::vector<Drawn> seen;
  for (std::size_t t = 0; t < classes.size(); ++t) {
    const auto at = [&](std::size_t k) -> const Eigen::Vector3d& {
      const auto node = preview.boundary.nodes[static_cast<std::size_t>(preview.boundary.triangles[t][k])];
      return preview.mesh.nodes[static_cast<std::size_t>(node)];
    };
    const double turned = camera.turnedToEye((at(1) - at(0)).cross(at(2) - at(0)).normalized());
    if (!(turned > 0)) continue;
    const Eigen::Vector3d a = camera.place(at(0)), b = camera.place(at(1)), c = camera.place(at(2));
    seen.push_back(
        {a.z() + b.z() + c.z(), printed("<path color=\"%s\" d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fZ\"/>\n",
                                        colourOf(kClasses[classes[t]], 0.6 + 0.4 * turned).c_str(), a.x(),
                                        a.y(), b.x(), b.y(), c.x(), c.y())});
  }
  std::stable_sort(seen.begin(), seen.end(),
                   [](const Drawn& a, const Drawn& b) { return a.depth < b.depth; });
  std::string svg = "<g class=\"surface\">\n";
  for (const Drawn& triangle : seen) svg += triangle.path;
  return svg + "</g>\n";
}

std::string lengthBar(const picture::Camera& camera, double left, double y) {
  const double length = program::niceTicks(0.0, kCell / camera.scale() / 3.0, 1)[1];
  return printed("<path class=\"line\" d=\"M%.1f %.1fv6h%.1fv-6\"/>\n", left, y - 6,
                 length * camera.scale()) +
         svgText(left + length * camera.scale() + 8, y, printed("%.6g mm", 1e3 * length));
}

std::string legend(const Preview& preview, double y) {
  const SurfacePart* const parts[] = {&preview.held, &preview.touchable, &preview.neither};
  std::string svg;
  for (std::size_t i = 0; i < 3; ++i) {
    const double left = kMargin + static_cast<double>(i) * (kCell + kGap);
    svg += printed("<rect x=\"%.1f\" y=\"%.1f\" width=\"18\" height=\"14\" fill=\"%s\"/>\n", left, y - 12,
                   colourOf(kClasses[i], 1.0).c_str());
    svg += svgText(left + 26, y, printed("%s, %.4g cm²", kClasses[i].name, 1e4 * parts[i]->area));
  }
  return svg;
}

}  // namespace

std::string clampPicture(const Preview& preview) {
  std::vector<double> positions;
  for (const auto& x : preview.mesh.nodes) positions.insert(positions.end(), x.data(), x.data() + 3);
  const std::vector<std::size_t> classes = classesOf(preview);
  std::string body = legend(preview, kTop);
  const double row = kCell + 2 * kCaption + kGap;
  for (std::size_t i = 0; i < std::size(kViews); ++i) {
    const double left = kMargin + static_cast<double>(i % 3) * (kCell + kGap);
    const double top = kTop + kGap + static_cast<double>(i / 3) * row;
    const picture::ColouredSurface surface{positions, {}, {}, kViews[i].towards_eye};
    const picture::Camera camera(surface, {left, top + kCaption, kCell, kCell});
    body += svgText(left, top + 12, kViews[i].name) + drawn(preview, classes, camera) +
            lengthBar(camera, left, top + kCaption + kCell + 18);
  }
  const double width = 2 * kMargin + 3 * kCell + 2 * kGap, height = kTop + kGap + 2 * row;
  return program::svgStart(
             width, height,
             ".surface { fill: currentColor; stroke: currentColor; stroke-width: 0.7; stroke-linejoin: "
             "round; }\n.line { fill: none; stroke: currentColor; stroke-width: 1.5; }\n") +
         svgText(kMargin, 28, "what is held, and what a tool can touch", " class=\"title\"") + body +
         "</svg>\n";
}

}  // namespace palpate::organ
