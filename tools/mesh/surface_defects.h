// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tools/mesh/triangle_surface.h"

namespace palpate::mesh {

/// Pairs of triangles that cross are sought up to this number.
inline constexpr std::size_t kMostCrossings = 1'000'000;

/// One kind of defect of a surface: how many there are, and the first few.
struct SurfaceDefect {
  /// Where one of them is.
  struct Example {
    Eigen::Vector3d place;                  ///< m
    std::vector<std::int64_t> triangles{};  ///< numbers in the file
  };

  std::size_t count{0};
  std::string what;               ///< with the count: "2 holes"
  std::vector<Example> examples;  ///< at most three
};

/// All that keeps a surface from bounding solids, kind by kind: coordinates that are not finite, triangles without
/// area, triangles that are there twice, holes, edges in more than two triangles, edges that both triangles pass in
/// the same direction, vertices that join several fans, pairs of triangles that cross. Empty for a sound surface.
///   Pairs that cross are sought where all coordinates are finite, and told as "at least" so many from kMostCrossings on;
///   triangles without area and twins do not count for them.
/// Cost O(T log T) plus the pairs of triangles whose boxes overlap along x. Real-time: no.
[[nodiscard]] std::vector<SurfaceDefect> surfaceDefects(const TriangleSurface& surface);

/// Defects in one line: "2 holes: the surface is not closed, at (x y z) m (triangle 3), (x y z) m (triangle 9); 20 pairs of
/// triangles intersect: the surface cuts itself, at (x y z) m (triangles 3 and 9), ...".
[[nodiscard]] std::string inWords(const std::vector<SurfaceDefect>& defects);

/// Pairs of triangles (0-based, the smaller first) that cut or overlap outside their shared corners and edges,
/// ascending.
///   Triangles with a corner twice or without finite corners take no part.
/// @param most  as many are sought: a surface that lies over itself has a number that grows with the square of its triangles'
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> selfIntersections(
    const TriangleSurface& surface, std::size_t most = kMostCrossings);

}  // namespace palpate::mesh
