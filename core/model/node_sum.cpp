// SPDX-License-Identifier: Apache-2.0
#include "core/model/node_sum.h"

namespace palpate {

void NodeSum::zero() noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < count_; ++i) u_[index(reached_[i])] = {};
}

void NodeSum::clear() noexcept PALPATE_NONBLOCKING {
  zero();
  for (std::size_t i = 0; i < count_; ++i) is_reached_[index(reached_[i])] = 0;
  count_ = 0;
}

void NodeSum::reach(std::span<const std::int32_t> nodes) noexcept PALPATE_NONBLOCKING {
  for (const std::int32_t node : nodes) {
    if (is_reached_[index(node)] != 0) continue;
    is_reached_[index(node)] = 1;
    reached_[count_++] = node;
  }
}

}  // namespace palpate
