// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/bounding_volumes.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace palpate {

namespace {

constexpr std::int32_t kLeafTriangles = 4;
/// Children hold half the triangles, rounded up: 2^31 triangles make 31 levels, one waiting sibling on each.
constexpr std::size_t kStack = 40;

}  // namespace

BoundingVolumes::BoundingVolumes(std::span<const double> positions, std::span<const std::int32_t> triangles)
    : positions_(positions), triangles_(triangles), order_(triangles.size() / 3) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vec3> centres(order_.size());
  for (std::size_t t = 0; t < centres.size(); ++t) {
    const auto triangle = static_cast<std::int32_t>(t);
    centres[t] = (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3.0;
  }
  boxes_.reserve(order_.size());
  if (!order_.empty()) build(0, static_cast<std::int32_t>(order_.size()), centres);
}

Vec3 BoundingVolumes::corner(std::int32_t triangle, int k) const noexcept {
  const auto entry = 3 * static_cast<std::size_t>(triangle) + static_cast<std::size_t>(k);
  return Eigen::Map<const Vec3>(positions_.data() + 3 * static_cast<std::size_t>(triangles_[entry]));
}

BoundingVolumes::Box BoundingVolumes::boxOf(std::int32_t begin, std::int32_t end) const {
  Box box;
  box.low.fill(std::numeric_limits<double>::infinity());
  box.high.fill(-std::numeric_limits<double>::infinity());
  for (std::int32_t i = begin; i < end; ++i)
    for (int k = 0; k < 3; ++k) {
      const Vec3 point = corner(order_[static_cast<std::size_t>(i)], k);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], point[static_cast<Eigen::Index>(axis)]);
        box.high[axis] = std::max(box.high[axis], point[static_cast<Eigen::Index>(axis)]);
      }
    }
  return box;
}

void BoundingVolumes::build(std::int32_t begin, std::int32_t end, std::span<const Vec3> centres) {
  const std::size_t self = boxes_.size();
  boxes_.push_back(boxOf(begin, end));
  boxes_[self].first = begin;
  boxes_[self].count = end - begin;
  if (end - begin <= kLeafTriangles) return;
  const Box& box = boxes_[self];
  std::size_t axis = 0;
  for (std::size_t other = 1; other < 3; ++other)
    if (box.high[other] - box.low[other] > box.high[axis] - box.low[axis]) axis = other;
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::int32_t a, std::int32_t b) {
                     const auto along = static_cast<Eigen::Index>(axis);
                     return centres[static_cast<std::size_t>(a)][along] <
                            centres[static_cast<std::size_t>(b)][along];
                   });
  build(begin, middle, centres);
  const auto right = static_cast<std::int32_t>(boxes_.size());
  build(middle, end, centres);
  boxes_[self].first = right;
  boxes_[self].count = 0;
}

double BoundingVolumes::squaredDistance(const Box& box, const Vec3& p) const noexcept {
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = p[static_cast<Eigen::Index>(axis)];
    const double outside = std::max({box.low[axis] - x, 0.0, x - box.high[axis]});
    sum += outside * outside;
  }
  return sum;
}

void BoundingVolumes::visitLeaf(const Box& box, const Vec3& p, Hit& best) const noexcept {
  for (std::int32_t i = box.first; i < box.first + box.count; ++i) {
    const std::int32_t triangle = order_[static_cast<std::size_t>(i)];
    const TriangleHit hit =
        closestOnTriangle(p, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
    if (best.triangle < 0 || hit.squared_distance < best.where.squared_distance) best = {triangle, hit};
  }
}

BoundingVolumes::Hit BoundingVolumes::closest(const Vec3& p) const noexcept PALPATE_NONBLOCKING {
  struct Waiting {
    std::int32_t box;
    double squared_distance;
  };
  std::array<Waiting, kStack> stack;
  std::size_t depth = 0;
  Hit best;
  if (!boxes_.empty()) stack[depth++] = {0, 0.0};
  while (depth > 0) {
    const Waiting next = stack[--depth];
    if (best.triangle >= 0 && next.squared_distance >= best.where.squared_distance) continue;
    const Box& box = boxes_[static_cast<std::size_t>(next.box)];
    if (box.count > 0) {
      visitLeaf(box, p, best);
      continue;
    }
    Waiting near{next.box + 1, squaredDistance(boxes_[static_cast<std::size_t>(next.box) + 1], p)};
    Waiting far{box.first, squaredDistance(boxes_[static_cast<std::size_t>(box.first)], p)};
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    stack[depth++] = far;  // the nearer one is looked at first, and then often spares us the other
    stack[depth++] = near;
  }
  return best;
}

}  // namespace palpate
