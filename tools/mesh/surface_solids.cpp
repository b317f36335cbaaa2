// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/surface_solids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace palpate::mesh {
namespace {

using Vec3 = Eigen::Vector3d;

// One closed part, facing outward.
struct Part {
  TriangleSurface surface{};
  double volume{0};
  Eigen::AlignedBox3d box{};
  std::vector<std::size_t> around{};  // the parts that it lies in
};

void turnOver(TriangleSurface& surface) {
  for (auto& t : surface.triangles) std::swap(t[1], t[2]);
}

/// The triangles of some parts, and the vertices that these use, in their order.
TriangleSurface taken(const TriangleSurface& surface, const std::vector<std::size_t>& part,
                      std::size_t wanted) {
  std::vector<std::int32_t> index(surface.vertices.size(), -1);
  for (std::size_t t = 0; t < part.size(); ++t)
    if (part[t] == wanted)
      for (const auto v : surface.triangles[t]) index[static_cast<std::size_t>(v)] = 0;
  TriangleSurface own;
  for (std::size_t v = 0; v < index.size(); ++v) {
    if (index[v] < 0) continue;
    index[v] = static_cast<std::int32_t>(own.vertices.size());
    own.vertices.push_back(surface.vertices[v]);
    own.vertex_tags.push_back(surface.vertex_tags[v]);
  }
  for (std::size_t t = 0; t < part.size(); ++t) {
    if (part[t] != wanted) continue;
    own.triangles.push_back(surface.triangles[t]);
    for (auto& v : own.triangles.back()) v = index[static_cast<std::size_t>(v)];
    own.triangle_tags.push_back(surface.triangle_tags[t]);
  }
  return own;
}

bool isInside(const Vec3& x, const Part& part) {
  if (!part.box.contains(x)) return false;
  double angle = 0;
  for (const auto& t : part.surface.triangles) {
    const auto at = [&](std::size_t k) -> Vec3 {
      return part.surface.vertices[static_cast<std::size_t>(t[k])] - x;
    };
    const Vec3 a = at(0), b = at(1), c = at(2);
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(angle) > 2 * std::numbers::pi;
}

std::vector<Part> outwardParts(const TriangleSurface& surface) {
  const std::vector<std::size_t> number = partsOf(surface);
  std::vector<Part> parts;
  for (std::size_t n = 0; n <= *std::max_element(number.begin(), number.end()); ++n) {
    Part part;
    part.surface = taken(surface, number, n);
    part.volume = enclosedVolume(part.surface);
    if (part.volume < 0) turnOver(part.surface);
    part.volume = std::abs(part.volume);
    for (const auto& x : part.surface.vertices) part.box.extend(x);
    parts.push_back(std::move(part));
  }
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = 0; j < parts.size(); ++j)
      if (i != j && isInside(parts[i].surface.vertices.front(), parts[j])) parts[i].around.push_back(j);
  return parts;
}

void append(TriangleSurface& surface, const TriangleSurface& other) {
  const auto offset = static_cast<std::int32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), other.vertices.begin(), other.vertices.end());
  surface.vertex_tags.insert(surface.vertex_tags.end(), other.vertex_tags.begin(), other.vertex_tags.end());
  surface.triangle_tags.insert(surface.triangle_tags.end(), other.triangle_tags.begin(),
                               other.triangle_tags.end());
  for (const auto& t : other.triangles)
    surface.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

void addCavities(Solid& solid, const std::vector<Part>& parts, std::size_t outer) {
  for (const Part& part : parts) {
    const bool is_in_it = std::find(part.around.begin(), part.around.end(), outer) != part.around.end();
    if (!is_in_it || part.around.size() != parts[outer].around.size() + 1) continue;
    TriangleSurface inward = part.surface;
    turnOver(inward);
    append(solid.surface, inward);
    solid.volume -= part.volume;
    solid.cavities.push_back({part.volume, part.box.center()});
  }
}

}  // namespace

std::vector<std::size_t> partsOf(const TriangleSurface& surface) {
  std::vector<std::size_t> parent(surface.vertices.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::int32_t vertex) {
    auto v = static_cast<std::size_t>(vertex);
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : surface.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  std::map<std::size_t, std::size_t> number;
  std::vector<std::size_t> parts;
  for (const auto& t : surface.triangles)
    parts.push_back(number.emplace(root(t[0]), number.size()).first->second);
  return parts;
}

std::vector<Solid> solidsOf(const TriangleSurface& surface) {
  const std::vector<Part> parts = outwardParts(surface);
  std::vector<Solid> solids;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].around.size() % 2 != 0) continue;
    solids.push_back({parts[i].surface, parts[i].volume, parts[i].box.center(), {}});
    addCavities(solids.back(), parts, i);
  }
  std::stable_sort(solids.begin(), solids.end(),
                   [](const Solid& a, const Solid& b) { return a.volume > b.volume; });
  return solids;
}

}  // namespace palpate::mesh
