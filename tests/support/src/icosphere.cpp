// SPDX-License-Identifier: Apache-2.0
#include "icosphere.h"

#include <algorithm>
#include <map>
#include <utility>

namespace palpate::testing {

namespace {

/// The twelve corners: the even permutations of (0, +-1, +-golden); faces are the triples that lie at edge
/// length 2.
Icosphere icosahedron() {
  const double golden = (1.0 + std::sqrt(5.0)) / 2.0;
  Icosphere solid;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-golden, golden}) {
      solid.nodes.emplace_back(0.0, a, b);
      solid.nodes.emplace_back(a, b, 0.0);
      solid.nodes.emplace_back(b, 0.0, a);
    }
  const auto adjacent = [&](std::size_t i, std::size_t j) {
    return std::abs((solid.nodes[i] - solid.nodes[j]).norm() - 2.0) < 1e-9;
  };
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t j = i + 1; j < 12; ++j)
      for (std::size_t k = j + 1; k < 12; ++k) {
        if (!adjacent(i, j) || !adjacent(j, k) || !adjacent(i, k)) continue;
        std::array<std::int32_t, 3> face{static_cast<std::int32_t>(i), static_cast<std::int32_t>(j),
                                         static_cast<std::int32_t>(k)};
        if (solid.nodes[i].cross(solid.nodes[j]).dot(solid.nodes[k]) < 0.0) std::swap(face[1], face[2]);
        solid.triangles.push_back(face);
      }
  for (Vec3& node : solid.nodes) node.normalize();
  return solid;
}

/// Each triangle becomes four.
void subdivide(Icosphere& sphere) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middle;
  const auto between = [&](std::int32_t a, std::int32_t b) {
    const auto [place, fresh] =
        middle.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(sphere.nodes.size()));
    if (fresh)
      sphere.nodes.push_back(
          (sphere.nodes[static_cast<std::size_t>(a)] + sphere.nodes[static_cast<std::size_t>(b)])
              .normalized());
    return place->second;
  };
  std::vector<std::array<std::int32_t, 3>> finer;
  for (const auto& [a, b, c] : sphere.triangles) {
    const std::int32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  sphere.triangles = std::move(finer);
}

}  // namespace

Icosphere icosphere(int subdivisions) {
  Icosphere sphere = icosahedron();
  for (int i = 0; i < subdivisions; ++i) subdivide(sphere);
  return sphere;
}

}  // namespace palpate::testing
