// SPDX-License-Identifier: Apache-2.0
#include "core/surface/divided_surface.h"

#include <cmath>
#include <numbers>

#include "core/base/index.h"

namespace palpate {

namespace {

using Three = std::array<std::int32_t, 3>;

/// Middle of the cubic over an edge.
Vec3 middle(const DividedSurface& coarse, std::int32_t a, std::int32_t b) {
  const Vec3 along = coarse.position[index(b)] - coarse.position[index(a)];
  const Vec3 &m = coarse.normal[index(a)], &n = coarse.normal[index(b)];
  const Vec3 bend = n * n.dot(along) - m * m.dot(along);  // (P_a - P_b) along
  return 0.5 * (coarse.position[index(a)] + coarse.position[index(b)]) + 0.125 * bend;
}

/// Which node of the neighbour a node of the triangle is.
std::size_t placeOf(std::int32_t node, const Three& in) {
  return in[0] == node ? 0 : in[1] == node ? 1 : 2;
}

/// The new node on each side of each triangle; adds their positions to `fine`. The second triangle at an edge takes the first's.
std::vector<Three> addMiddles(const DividedSurface& coarse, DividedSurface& fine) {
  std::vector<Three> middles(coarse.triangle.size());
  const std::size_t edges = 3 * middles.size() / 2;
  fine.position.reserve(fine.position.size() + edges);
  fine.rest.reserve(fine.rest.size() + edges);
  for (std::size_t t = 0; t < middles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = coarse.triangle[t][(k + 1) % 3], b = coarse.triangle[t][(k + 2) % 3];
      const std::size_t other = index(coarse.neighbour[t][k]);
      if (other < t) {
        // There the edge goes from b to a.
        middles[t][k] = middles[other][(placeOf(b, coarse.triangle[other]) + 2) % 3];
        continue;
      }
      middles[t][k] = static_cast<std::int32_t>(fine.position.size());
      fine.position.push_back(middle(coarse, a, b));
      fine.rest.push_back(0.5 * (coarse.rest[index(a)] + coarse.rest[index(b)]));
    }
  return middles;
}

/// The triangle at corner k of face t: its own middle one is across from that corner; across from its node j it meets the
/// triangle that lies at the same corner of the face's neighbour.
Three neighboursAtCorner(const DividedSurface& coarse, std::size_t t, std::size_t k) {
  Three across{};
  for (std::size_t j = 0; j < 3; ++j) {
    const std::int32_t other = coarse.neighbour[t][j];
    across[j] = j == k ? static_cast<std::int32_t>(4 * t + 3)
                       : 4 * other + static_cast<std::int32_t>(
                                         placeOf(coarse.triangle[t][k], coarse.triangle[index(other)]));
  }
  return across;
}

/// Normals of the nodes. @return whether each triangle has an area
bool findNormals(DividedSurface& surface) {
  surface.normal.assign(surface.position.size(), Vec3::Zero());
  for (const Three& node : surface.triangle) {
    const Vec3 &A = surface.position[index(node[0])], &B = surface.position[index(node[1])],
               &C = surface.position[index(node[2])];
    const Vec3 c = B - A, b = C - A, a = C - B, area = c.cross(b);
    const double size = area.norm();
    if (!(size > 0.0 && std::isfinite(size))) return false;
    const Vec3 face = area / size;
    const double at_A = std::atan2(size, c.dot(b)), at_B = std::atan2(size, -c.dot(a));
    surface.normal[index(node[0])] += at_A * face;
    surface.normal[index(node[1])] += at_B * face;
    surface.normal[index(node[2])] += (std::numbers::pi - at_A - at_B) * face;
  }
  for (Vec3& n : surface.normal) n.normalize();
  return true;
}

}  // namespace

std::optional<DividedSurface> DividedSurface::divided() const {
  DividedSurface fine{position, {}, rest, {}, {}};
  const std::vector<Three> middles = addMiddles(*this, fine);
  fine.triangle.reserve(4 * triangle.size());
  fine.neighbour.reserve(4 * triangle.size());
  for (std::size_t t = 0; t < triangle.size(); ++t) {
    const auto& [a, b, c] = triangle[t];
    const auto& [across_a, across_b, across_c] = middles[t];
    for (const Three& part : {Three{a, across_c, across_b}, Three{across_c, b, across_a},
                              Three{across_b, across_a, c}, Three{across_a, across_b, across_c}})
      fine.triangle.push_back(part);
    for (std::size_t k = 0; k < 3; ++k) fine.neighbour.push_back(neighboursAtCorner(*this, t, k));
    const auto first = static_cast<std::int32_t>(4 * t);
    fine.neighbour.push_back({first, first + 1, first + 2});
  }
  if (!findNormals(fine)) return std::nullopt;
  return fine;
}

}  // namespace palpate
