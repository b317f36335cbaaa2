// SPDX-License-Identifier: Apache-2.0
#include "core/surface/bounding_volumes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

namespace {

/// Children hold a quarter of the faces, rounded up: 2^31 triangles make 17 levels, three waiting on each.
constexpr std::size_t kStack = 64;

/// x as a float that lies a little further along `way`, 1 or -1.
float rounded(double x, double way) noexcept PALPATE_NONBLOCKING {
  using Float = std::numeric_limits<float>;
  const double beyond = x + way * std::max(double(Float::epsilon()) * std::abs(x), double(Float::min()));
  if (std::abs(beyond) <= double(Float::max())) return static_cast<float>(beyond);
  return static_cast<float>(way) * (beyond * way > 0.0 ? Float::infinity() : -Float::max());
}

}  // namespace

/// That of no triangles is infinitely far from everywhere.
struct BoundingVolumes::Box {
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::array<float, 3> low{kInfinity, kInfinity, kInfinity}, high{kInfinity, kInfinity, kInfinity};
};

BoundingVolumes::BoundingVolumes(std::span<const double> positions, std::span<const std::int32_t> triangles,
                                 int levels)
    : positions_(positions), triangles_(triangles), levels_(levels) {
  std::vector<Leaf> leaves((triangles.size() / 3) >> (2 * levels));
  for (std::size_t f = 0; f < leaves.size(); ++f) leaves[f] = leafOf(static_cast<std::int32_t>(f));
  nodes_.reserve(triangles.size() / 6);
  if (leaves.size() == 1 && levels > 0)
    (void)buildFace(0, levels);
  else if (!leaves.empty())
    (void)build(leaves);
}

/// A face by the mean of its corners: corner k is node k of the part that lies there at each level.
BoundingVolumes::Leaf BoundingVolumes::leafOf(std::int32_t face) const {
  const std::int32_t parts = 1 << (2 * levels_), turn = (parts - 1) / 3;
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 3; ++k) sum += corner(face * parts + k * turn, k);
  return {sum / 3.0, face};
}

Vec3 BoundingVolumes::corner(std::int32_t triangle, int k) const noexcept PALPATE_NONBLOCKING {
  const auto entry = 3 * static_cast<std::size_t>(triangle) + static_cast<std::size_t>(k);
  return Eigen::Map<const Vec3>(positions_.data() + 3 * static_cast<std::size_t>(triangles_[entry]));
}

BoundingVolumes::Box BoundingVolumes::boxOfTriangle(std::int32_t triangle) const {
  const Vec3 A = corner(triangle, 0), B = corner(triangle, 1), C = corner(triangle, 2);
  Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto of = static_cast<Eigen::Index>(axis);
    box.low[axis] = rounded(std::min({A[of], B[of], C[of]}), -1.0);
    box.high[axis] = rounded(std::max({A[of], B[of], C[of]}), 1.0);
  }
  return box;
}

/// What the boxes of its children cover together.
BoundingVolumes::Box BoundingVolumes::boxOf(const Node& node) {
  Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.high[axis] = -Box::kInfinity;
    for (std::size_t k = 0; k < kChildren; ++k) {
      if (node.low[axis][k] == Box::kInfinity) continue;  // no triangles
      box.low[axis] = std::min(box.low[axis], node.low[axis][k]);
      box.high[axis] = std::max(box.high[axis], node.high[axis][k]);
    }
  }
  return box;
}

/// Halved where the centres spread most, and each half again.
std::array<std::span<BoundingVolumes::Leaf>, BoundingVolumes::kChildren> BoundingVolumes::divided(
    std::span<Leaf> leaves) {
  const auto halved = [](std::span<Leaf> part) {
    const auto middle = static_cast<std::ptrdiff_t>(part.size() / 2);
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Leaf& leaf : part) {
      low = low.cwiseMin(leaf.centre);
      high = high.cwiseMax(leaf.centre);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    std::nth_element(part.begin(), part.begin() + middle, part.end(),
                     [axis](const Leaf& a, const Leaf& b) { return a.centre[axis] < b.centre[axis]; });
    const auto size = static_cast<std::size_t>(middle);
    return std::array{part.first(size), part.subspan(size)};
  };
  const auto [left, right] = halved(leaves);
  const auto [a, b] = halved(left);
  const auto [c, d] = halved(right);
  return {a, b, c, d};
}

std::int32_t BoundingVolumes::build(std::span<Leaf> leaves) {
  const auto self = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  const auto parts = divided(leaves);
  for (std::size_t k = 0; k < kChildren; ++k) {
    const std::span<Leaf> part = parts[k];
    if (part.empty())
      adopt(self, k, Box{}, ~0);
    else
      adopt(self, k, part.size() == 1 ? buildFace(part.front().face, levels_) : build(part));
  }
  return self;
}

/// @param levels  how often it was divided  @return its node, or ~triangle
std::int32_t BoundingVolumes::buildFace(std::int32_t face, int levels) {
  if (levels == 0) return ~face;
  const auto self = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  for (std::size_t k = 0; k < kChildren; ++k)
    adopt(self, k, buildFace(4 * face + static_cast<std::int32_t>(k), levels - 1));
  return self;
}

void BoundingVolumes::adopt(std::int32_t self, std::size_t k, std::int32_t child) {
  const Box box = child < 0 ? boxOfTriangle(~child) : boxOf(nodes_[static_cast<std::size_t>(child)]);
  adopt(self, k, box, child);
}

void BoundingVolumes::adopt(std::int32_t self, std::size_t k, const Box& box, std::int32_t child) {
  Node& node = nodes_[static_cast<std::size_t>(self)];
  node.child[k] = child;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.low[axis][k] = box.low[axis];
    node.high[axis][k] = box.high[axis];
  }
}

BoundingVolumes::Distances BoundingVolumes::squaredDistances(const Node& node,
                                                             const Vec3& p) noexcept PALPATE_NONBLOCKING {
  Distances sum{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = p[static_cast<Eigen::Index>(axis)];
    for (std::size_t k = 0; k < kChildren; ++k) {
      const double before = double(node.low[axis][k]) - x, behind = x - double(node.high[axis][k]);
      const double farther = before > behind ? before : behind;
      const double outside = farther > 0.0 ? farther : 0.0;
      sum[k] += outside * outside;
    }
  }
  return sum;
}

TriangleHit BoundingVolumes::hit(std::int32_t triangle, const Vec3& p) const noexcept PALPATE_NONBLOCKING {
  return closestOnTriangle(p, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
}

BoundingVolumes::Hit BoundingVolumes::closest(const Vec3& p) const noexcept PALPATE_NONBLOCKING {
  struct Waiting {
    std::int32_t child;
    double squared_distance;
  };
  std::array<Waiting, kStack> stack;
  std::size_t depth = 0;
  Hit best;
  if (nodes_.empty()) return best;
  best.where.squared_distance = std::numeric_limits<double>::infinity();
  stack[depth++] = {0, 0.0};
  while (depth > 0) {
    const Waiting next = stack[--depth];
    if (next.squared_distance >= best.where.squared_distance) continue;
    if (next.child < 0) {
      const TriangleHit where = hit(~next.child, p);
      if (where.squared_distance < best.where.squared_distance) best = {~next.child, where};
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(next.child)];
    const Distances distances = squaredDistances(node, p);
    const std::size_t bottom = depth;
    for (std::size_t k = 0; k < kChildren; ++k) {
      if (!(distances[k] < best.where.squared_distance)) continue;
      std::size_t at = depth++;  // the nearest on top: visited first, it often rules out the others
      for (; at > bottom && stack[at - 1].squared_distance < distances[k]; --at) stack[at] = stack[at - 1];
      stack[at] = {node.child[k], distances[k]};
    }
  }
  return best.triangle < 0 ? Hit{0, hit(0, p)} : best;  // all squares overflow: any triangle will do
}

}  // namespace palpate
