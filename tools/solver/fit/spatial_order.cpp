// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/spatial_order.h"

#include <algorithm>
#include <numeric>

namespace palpate::solver {

namespace {

void halve(std::span<const Vec3> places, std::span<std::int32_t> order) {
  constexpr std::size_t kFew = 8;
  if (order.size() <= kFew) return;
  const auto at = [&](std::int32_t i) -> const Vec3& { return places[static_cast<std::size_t>(i)]; };
  Vec3 low = at(order[0]), high = low;
  for (const std::int32_t i : order) {
    low = low.cwiseMin(at(i));
    high = high.cwiseMax(at(i));
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t half = order.size() / 2;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return at(a)[axis] < at(b)[axis]; });
  halve(places, order.first(half));
  halve(places, order.subspan(half));
}

}  // namespace

std::vector<std::int32_t> spatialOrder(std::span<const Vec3> places) {
  std::vector<std::int32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  halve(places, order);
  return order;
}

}  // namespace palpate::solver
