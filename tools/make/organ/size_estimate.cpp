// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/size_estimate.h"

#include <algorithm>
#include <cmath>

#include "tools/program/printed.h"

namespace palpate::organ {
namespace {

constexpr double kPerCube = 5.0;                     // tetrahedra in a cube of their edge's length
constexpr double kPerSquare = 1.0;                   // tetrahedra more for each such square of the surface
constexpr double kTrianglesPerSquare = 2.7;          // 4 / sqrt(3) if all were regular
constexpr double kAtInner = 6.6, kAtOuter = 2.5;     // tetrahedra per node inside, and on the surface
constexpr double kBytesAtAll = 1.0e8, kBytes = 900;  // for each tetrahedron
constexpr double kSecondsAtAll = 0.3, kSeconds = 2.5e-5;  // for each tetrahedron

double tetrahedraIn(const Body& body, const mesh::ElementSizes& sizes) {
  constexpr int kShells = 400;
  const double depth = 3 * body.volume / body.area;  // of a ball: its radius
  double count = 0, whole = 0;
  for (int i = 0; i < kShells; ++i) {
    const double share = (i + 0.5) / kShells, left = 1 - share;
    const double grown = sizes.surface + sizes.growth * share * depth;
    const double size =
        sizes.isGraded() ? std::min(std::max(sizes.inner, sizes.surface), grown) : sizes.surface;
    count += left * left / (size * size * size);
    whole += left * left;
  }
  return kPerCube * body.volume * count / whole + kPerSquare * body.area / (sizes.surface * sizes.surface);
}

/// To two digits: no more are known.
double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::max(value, 1.0))) - 1);
  return unit * std::round(value / unit);
}

}  // namespace

std::string SizeEstimate::inWords() const {
  return program::printed("about %.0f nodes, %.0f tetrahedra; %.10g s and %.0f MB of memory to fill",
                          rounded(nodes), rounded(tetrahedra), rounded(seconds), rounded(bytes / 1e6));
}

SizeEstimate estimate(const Body& body, const mesh::ElementSizes& sizes, int order) {
  const double triangles = kTrianglesPerSquare * body.area / (sizes.surface * sizes.surface);
  const double outer = triangles / 2 + 2;
  const double tetrahedra = std::max(tetrahedraIn(body, sizes), kAtOuter * outer / 2);
  const double corners = outer + std::max(0.0, (tetrahedra - kAtOuter * outer) / kAtInner);
  // Euler's formula: a ball of tetrahedra has this many edges.
  const double edges = corners + tetrahedra + triangles / 2 - 1;
  return {order == 2 ? corners + edges : corners, tetrahedra, kBytesAtAll + kBytes * tetrahedra,
          kSecondsAtAll + kSeconds * tetrahedra};
}

double smallestSize(const Body& body, mesh::ElementSizes sizes, int order, double most_nodes) {
  const double inner_over_surface = sizes.isGraded() ? sizes.inner / sizes.surface : 0;
  const auto nodesAt = [&](double size) {
    sizes.surface = size;
    sizes.inner = inner_over_surface * size;
    return estimate(body, sizes, order).nodes;
  };
  double low = 1e-6 * std::cbrt(body.volume), high = 10 * std::cbrt(body.volume);
  for (int i = 0; i < 80; ++i) {
    const double middle = std::sqrt(low * high);
    (nodesAt(middle) > most_nodes ? low : high) = middle;
  }
  return high;
}

}  // namespace palpate::organ
