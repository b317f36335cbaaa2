// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/domain_rings.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace palpate::solver {

std::vector<double> leastWithinTwoRings(std::span<const std::array<std::int32_t, 3>> triangles,
                                        std::span<const std::int32_t> nodes, std::span<const double> radii) {
  const auto at = [](std::int32_t node) { return static_cast<std::size_t>(node); };
  std::int32_t last = 0;
  for (const auto& t : triangles) last = std::max(last, *std::max_element(t.begin(), t.end()));
  for (const std::int32_t node : nodes) last = std::max(last, node);
  // A node without a position limits nobody.
  std::vector<double> least(at(last) + 1, std::numeric_limits<double>::infinity());
  for (std::size_t p = 0; p < nodes.size(); ++p) least[at(nodes[p])] = radii[p];
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<double> inner = least;
    for (const auto& t : triangles) {
      const double smallest = std::min({inner[at(t[0])], inner[at(t[1])], inner[at(t[2])]});
      for (const std::int32_t node : t) least[at(node)] = std::min(least[at(node)], smallest);
    }
  }
  std::vector<double> result;
  for (const std::int32_t node : nodes) result.push_back(least[at(node)]);
  return result;
}

}  // namespace palpate::solver
