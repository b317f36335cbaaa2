// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/drawn_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/base/index.h"
#include "tools/program/numbers.h"
#include "tools/program/printed.h"

namespace palpate::picture {

namespace {

using program::printed;
using Colour = std::array<double, 3>;

/// Light to dark, so that brightness alone tells them apart for readers who do not tell hues apart: YlGnBu of
/// C. Brewer, colorbrewer2.org.
constexpr std::array<Colour, 9> kColours{{{255, 255, 217},
                                          {237, 248, 177},
                                          {199, 233, 180},
                                          {127, 205, 187},
                                          {65, 182, 196},
                                          {29, 145, 192},
                                          {34, 94, 168},
                                          {37, 52, 148},
                                          {8, 29, 88}}};
constexpr Colour kGrey{160, 160, 160};

std::string hex(const Colour& colour, double light) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned>(std::lround(light * colour[k])); };
  return printed("#%02x%02x%02x", byte(0), byte(1), byte(2));
}

struct Corner {
  double x, y;    // px
  double number;  // of the surface
};
using Polygon = std::vector<Corner>;

/// What of a convex polygon has numbers above a level (side 1) or below it (side -1).
Polygon cut(const Polygon& polygon, double level, double side) {
  Polygon left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = side * (a.number - level), over_b = side * (b.number - level);
    if (over_a >= 0.0) left.push_back(a);
    if ((over_a < 0.0) == (over_b < 0.0)) continue;
    const double t = over_a / (over_a - over_b);
    left.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), level});
  }
  return left;
}

/// Nothing for what has no area.
std::string pathOf(const Polygon& polygon, const std::string& colour) {
  if (polygon.size() < 3) return {};
  std::string d;
  for (const Corner& corner : polygon) d += printed("%c%.1f %.1f", d.empty() ? 'M' : 'L', corner.x, corner.y);
  return "<path color=\"" + colour + "\" d=\"" + d + "Z\"/>\n";
}

Vec3 positionOf(const ColouredSurface& surface, std::size_t node) {
  return Eigen::Map<const Vec3>(surface.positions.data() + 3 * node);
}

struct SeenTriangle {
  double depth, light;
  std::array<std::size_t, 3> node;
};

std::vector<SeenTriangle> seenTriangles(const ColouredSurface& surface, const Camera& camera) {
  std::vector<SeenTriangle> seen;
  for (std::size_t t = 0; t < surface.triangles.size(); t += 3) {
    const std::array node{index(surface.triangles[t]), index(surface.triangles[t + 1]),
                          index(surface.triangles[t + 2])};
    const Vec3 a = positionOf(surface, node[0]), b = positionOf(surface, node[1]),
               c = positionOf(surface, node[2]);
    const double turned = camera.turnedToEye((b - a).cross(c - a).normalized());
    if (turned > 0.0) seen.push_back({camera.place((a + b + c) / 3.0).z(), 0.72 + 0.28 * turned, node});
  }
  std::stable_sort(seen.begin(), seen.end(),
                   [](const SeenTriangle& a, const SeenTriangle& b) { return a.depth < b.depth; });
  return seen;
}

}  // namespace

ColourSteps::ColourSteps(const std::vector<std::optional<double>>& numbers) {
  double low = 0.0, high = 0.0;
  for (const auto& number : numbers) {
    low = std::min(low, number.value_or(0.0));
    high = std::max(high, number.value_or(0.0));
  }
  ends_ = low < high ? program::niceTicks(low, high, 10) : std::vector{0.0, 1.0};
}

std::size_t ColourSteps::stepOf(double number) const {
  const auto inner = std::upper_bound(ends_.begin() + 1, ends_.end() - 1, number);
  return static_cast<std::size_t>(inner - ends_.begin()) - 1;
}

std::string ColourSteps::colour(std::size_t step, double light) const {
  const double place = count() > 1 ? static_cast<double>(step) / static_cast<double>(count() - 1) *
                                         static_cast<double>(kColours.size() - 1)
                                   : 0.0;
  const auto below = std::min(static_cast<std::size_t>(place), kColours.size() - 2);
  const double part = place - static_cast<double>(below);
  Colour colour{};
  for (std::size_t k = 0; k < 3; ++k)
    colour[k] = (1.0 - part) * kColours[below][k] + part * kColours[below + 1][k];
  return hex(colour, light);
}

Camera::Camera(const ColouredSurface& surface, const Frame& frame) {
  const Vec3 z = surface.towards_eye.normalized();
  const Vec3 up = std::abs(z.z()) < 0.95 ? Vec3::UnitZ() : Vec3::UnitY();
  const Vec3 x = up.cross(z).normalized();
  axes_ << x.transpose(), z.cross(x).transpose(), z.transpose();
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (std::size_t i = 0; 3 * i < surface.positions.size(); ++i) {
    const Vec3 eye = axes_ * positionOf(surface, i);
    low = low.cwiseMin(eye);
    high = high.cwiseMax(eye);
  }
  const Vec3 size = high - low;
  scale_ = std::min(frame.width / size.x(), frame.tallest / size.y());
  left_ = frame.left + 0.5 * (frame.width - scale_ * size.x()) - scale_ * low.x();
  top_ = frame.top + scale_ * high.y();
  bottom_ = frame.top + scale_ * size.y();
}

Vec3 Camera::place(const Vec3& X) const {
  const Vec3 eye = axes_ * X;
  return {left_ + scale_ * eye.x(), top_ - scale_ * eye.y(), eye.z()};
}

std::string drawnSurface(const ColouredSurface& surface, const Camera& camera, const ColourSteps& steps) {
  std::string svg;
  for (const SeenTriangle& triangle : seenTriangles(surface, camera)) {
    Polygon polygon;
    bool known = true;
    for (const std::size_t node : triangle.node) {
      const Vec3 at = camera.place(positionOf(surface, node));
      polygon.push_back({at.x(), at.y(), surface.numbers[node].value_or(0.0)});
      known = known && surface.numbers[node].has_value();
    }
    if (!known) svg += pathOf(polygon, hex(kGrey, triangle.light));
    for (std::size_t i = 0; known && i < steps.count(); ++i)
      svg += pathOf(cut(cut(polygon, steps.end(i), 1.0), steps.end(i + 1), -1.0),
                    steps.colour(i, triangle.light));
  }
  return svg;
}

bool isHidden(const ColouredSurface& surface, const Camera& camera, const Vec3& X) {
  const Vec3 p = camera.place(X);
  const double rounding = 0.5 / camera.scale();  // m
  const auto cross = [](const Vec3& a, const Vec3& b) { return a.x() * b.y() - a.y() * b.x(); };
  for (const SeenTriangle& triangle : seenTriangles(surface, camera)) {
    std::array<Vec3, 3> to;
    for (std::size_t k = 0; k < 3; ++k) to[k] = camera.place(positionOf(surface, triangle.node[k])) - p;
    const Vec3 weight(cross(to[1], to[2]), cross(to[2], to[0]), cross(to[0], to[1]));  // y goes down
    if (weight.maxCoeff() > 0.0 || weight.sum() == 0.0) continue;
    const double over = weight.dot(Vec3(to[0].z(), to[1].z(), to[2].z())) / weight.sum();
    if (over > rounding) return true;
  }
  return false;
}

std::string outlineOf(const RegionSurface& surface, const Camera& camera) {
  const auto place = [&](std::uint32_t node) {
    return camera.place(Eigen::Map<const Vec3>(surface.positions.data() + 3 * std::size_t{node}));
  };
  // Directed edges of the triangles that face the eye. Those of two such triangles are there both ways.
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t t = 0; t < surface.triangles.size(); t += 3) {
    const std::uint32_t* const node = surface.triangles.data() + t;
    const Vec3 one = place(node[1]) - place(node[0]), other = place(node[2]) - place(node[0]);
    if (one.x() * other.y() >= one.y() * other.x()) continue;  // y goes down
    for (std::size_t k = 0; k < 3; ++k) edges.emplace(node[k], node[(k + 1) % 3]);
  }
  std::multimap<std::uint32_t, std::uint32_t> next;
  for (const auto& [from, to] : edges)
    if (!edges.contains({to, from})) next.emplace(from, to);
  std::string d;
  while (!next.empty()) {
    char command = 'M';
    for (auto edge = next.begin(); edge != next.end(); command = 'L') {
      const auto [from, to] = *edge;
      d += printed("%c%.1f %.1f", command, place(from).x(), place(from).y());
      next.erase(edge);
      edge = next.find(to);
    }
    d += 'Z';
  }
  return d;
}

}  // namespace palpate::picture
