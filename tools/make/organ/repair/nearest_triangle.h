// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>

#include "tools/mesh/triangle_surface.h"

namespace palpate::organ {

/// Finds the triangle of a surface that is nearest to a point, by CGAL's tree of boxes.
class NearestTriangle {
 public:
  /// @param surface  may have defects; triangles without area or with coordinates that are not finite are never the nearest
  /// @throw MeshError when no triangle has an area
  explicit NearestTriangle(const mesh::TriangleSurface& surface);
  ~NearestTriangle();
  NearestTriangle(const NearestTriangle&) = delete;
  NearestTriangle& operator=(const NearestTriangle&) = delete;

  /// @return 0-based number. Cost O(log T).
  [[nodiscard]] std::size_t to(const Eigen::Vector3d& x) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace palpate::organ
