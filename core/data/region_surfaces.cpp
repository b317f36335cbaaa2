// SPDX-License-Identifier: Apache-2.0
#include "core/data/region_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/index.h"
#include "core/base/types.h"

namespace palpate {

namespace {

/// Faces of a tetrahedron of positive volume, counter-clockwise from outside.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

struct Face {
  std::array<std::int32_t, 3> key;  ///< its nodes, ascending
  std::int32_t number;              ///< 4 x tetrahedron + row of kFaces
};

std::int32_t regionOf(const ModelView& v, const Face& face) {
  return v.mesh_element_region[index(face.number / 4)];
}

std::array<std::int32_t, 3> cornersOf(const ModelView& v, std::size_t tetrahedron, std::size_t row) {
  std::array<std::int32_t, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k) corners[k] = v.mesh_tetrahedra[4 * tetrahedron + kFaces[row][k]];
  return corners;
}

/// By node: whether tetrahedra of several regions meet there.
std::vector<bool> nodesBetween(const ModelView& v) {
  constexpr std::int32_t kNone = -1;
  std::vector<std::int32_t> first(v.mesh_node_tag.size(), kNone);
  std::vector<bool> between(first.size(), false);
  for (std::size_t i = 0; i < v.mesh_tetrahedra.size(); ++i) {
    const std::size_t node = index(v.mesh_tetrahedra[i]);
    const std::int32_t region = v.mesh_element_region[i / 4];
    if (first[node] == kNone) first[node] = region;
    if (first[node] != region) between[node] = true;
  }
  return between;
}

/// All faces whose nodes are between regions, sorted: those of two tetrahedra are neighbours.
std::vector<Face> facesBetween(const ModelView& v) {
  const std::vector<bool> between = nodesBetween(v);
  const auto visit = [&](const auto& take) {
    for (std::size_t f = 0; f < v.mesh_tetrahedra.size(); ++f) {
      std::array<std::int32_t, 3> key = cornersOf(v, f / 4, f % 4);
      if (!std::all_of(key.begin(), key.end(), [&](std::int32_t node) { return between[index(node)]; }))
        continue;
      std::sort(key.begin(), key.end());
      take(Face{key, static_cast<std::int32_t>(f)});
    }
  };
  std::size_t count = 0;
  visit([&](const Face&) { ++count; });
  std::vector<Face> faces;
  faces.reserve(count);
  visit([&](const Face& face) { faces.push_back(face); });
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return std::pair(a.key, a.number) < std::pair(b.key, b.number);
  });
  return faces;
}

/// @return six times the volumes, m^3. @param surfaces  get their centres
std::vector<double> measure(const ModelView& v, std::vector<RegionSurface>& surfaces) {
  std::vector<double> volumes(surfaces.size(), 0.0);
  for (std::size_t t = 0; t < v.mesh_element_region.size(); ++t) {
    const auto X = [&](std::size_t k) {
      return Eigen::Map<const Vec3>(v.mesh_nodes.data() + 3 * index(v.mesh_tetrahedra[4 * t + k]));
    };
    const std::size_t region = index(v.mesh_element_region[t]);
    const double volume = std::abs((X(1) - X(0)).cross(X(2) - X(0)).dot(X(3) - X(0)));
    volumes[region] += volume;
    surfaces[region].centre += 0.25 * volume * (X(0) + X(1) + X(2) + X(3));
  }
  for (std::size_t r = 0; r < surfaces.size(); ++r)
    if (volumes[r] > 0.0) surfaces[r].centre /= volumes[r];
  return volumes;
}

/// @param number_of  volume node: its number in this surface, in the order in which faces name them
void add(const ModelView& v, const Face& face, std::map<std::int32_t, std::uint32_t>& number_of,
         RegionSurface& surface) {
  for (const std::int32_t node : cornersOf(v, index(face.number / 4), index(face.number % 4))) {
    const auto [at, is_new] = number_of.try_emplace(node, static_cast<std::uint32_t>(number_of.size()));
    surface.triangles.push_back(at->second);
    if (!is_new) continue;
    const auto X = v.mesh_nodes.subspan(3 * index(node), 3);
    surface.positions.insert(surface.positions.end(), X.begin(), X.end());
  }
}

}  // namespace

std::vector<RegionSurface> regionSurfaces(const ModelView& v) {
  std::vector<RegionSurface> surfaces(v.region_name.size());
  for (const std::int32_t region : v.mesh_element_region) ++surfaces[index(region)].tetrahedra;
  if (surfaces.empty()) return surfaces;
  const std::vector<double> volume = measure(v, surfaces);
  const auto sizeOf = [&](const Face& face) {
    const std::size_t region = index(regionOf(v, face));
    return std::pair(volume[region], region);
  };
  const std::vector<Face> faces = facesBetween(v);
  std::vector<std::map<std::int32_t, std::uint32_t>> number_of(surfaces.size());
  for (auto face = faces.begin(); face != faces.end();) {
    const auto next =
        std::find_if(face, faces.end(), [&](const Face& other) { return other.key != face->key; });
    if (next - face == 2 && regionOf(v, face[0]) != regionOf(v, face[1])) {
      const Face& smaller = sizeOf(face[0]) < sizeOf(face[1]) ? face[0] : face[1];
      const std::size_t region = index(regionOf(v, smaller));
      add(v, smaller, number_of[region], surfaces[region]);
    }
    face = next;
  }
  return surfaces;
}

}  // namespace palpate
