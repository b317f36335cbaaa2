// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/triangle_surface.h"

#include <Eigen/Geometry>

namespace palpate::mesh {

double enclosedVolume(const TriangleSurface& surface) {
  Eigen::AlignedBox3d box;
  for (const auto& x : surface.vertices) box.extend(x);
  const Eigen::Vector3d origin = box.center();
  double volume = 0;
  for (const auto& t : surface.triangles) {
    const auto at = [&](std::size_t k) -> Eigen::Vector3d {
      return surface.vertices[static_cast<std::size_t>(t[k])] - origin;
    };
    volume += at(0).dot(at(1).cross(at(2))) / 6;
  }
  return volume;
}

double areaOf(const TriangleSurface& surface) {
  double area = 0;
  for (const auto& t : surface.triangles) {
    const Eigen::Vector3d& a = surface.vertices[static_cast<std::size_t>(t[0])];
    area += (surface.vertices[static_cast<std::size_t>(t[1])] - a)
                .cross(surface.vertices[static_cast<std::size_t>(t[2])] - a)
                .norm() /
            2;
  }
  return area;
}

}  // namespace palpate::mesh
