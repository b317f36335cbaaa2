// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/repair/nearest_triangle.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "tools/mesh/mesh_error.h"

namespace palpate::organ {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;

constexpr double kFlat = 1e-10;  // area over longest edge squared, below which a triangle has none

}  // namespace

struct NearestTriangle::Tree {
  Triangles triangles;
  std::vector<std::size_t> numbers;  // of the triangles in the surface
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> boxes;
};

NearestTriangle::NearestTriangle(const mesh::TriangleSurface& surface) : tree_(std::make_unique<Tree>()) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto at = [&](std::size_t k) -> const Eigen::Vector3d& {
      return surface.vertices[static_cast<std::size_t>(surface.triangles[t][k])];
    };
    const Eigen::Vector3d ab = at(1) - at(0), ac = at(2) - at(0);
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    if (!(ab.cross(ac).norm() / 2 > kFlat * longest)) continue;  // also what is not finite
    const auto point = [&](std::size_t k) { return Kernel::Point_3(at(k).x(), at(k).y(), at(k).z()); };
    tree_->triangles.emplace_back(point(0), point(1), point(2));
    tree_->numbers.push_back(t);
  }
  if (tree_->triangles.empty()) throw mesh::MeshError("no triangle has an area");
  tree_->boxes.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->boxes.build();
}

NearestTriangle::~NearestTriangle() = default;

std::size_t NearestTriangle::to(const Eigen::Vector3d& x) const {
  const auto found = tree_->boxes.closest_point_and_primitive({x.x(), x.y(), x.z()}).second;
  return tree_->numbers[static_cast<std::size_t>(found - tree_->triangles.cbegin())];
}

}  // namespace palpate::organ
