// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/blocks.h"

#include <numeric>
#include <utility>

namespace palpate::solver {

namespace {

std::vector<std::int32_t> upTo(std::size_t entries) {
  std::vector<std::int32_t> order(entries);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

}  // namespace

Blocks::Blocks(std::vector<std::int32_t> order, std::size_t part, std::size_t most, const Ranks& ranks)
    : order_(std::move(order)), part_(part), parts_((order_.size() + part - 1) / part), ranks_(&ranks) {
  constexpr std::size_t kMultiple = 4;
  const std::size_t each = kMultiple * most;
  count_ = std::min(kMultiple * ((parts_ * part + each - 1) / each), parts_);
}

Blocks::Blocks(std::size_t entries, const Ranks& ranks, std::size_t part)
    : Blocks(upTo(entries), part, kMost, ranks) {}

int Blocks::rankOf(std::size_t block) const noexcept {
  int rank = 0;
  while (block >= firstOf(rank + 1)) ++rank;
  return rank;
}

}  // namespace palpate::solver
