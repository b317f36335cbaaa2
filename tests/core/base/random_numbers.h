// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>
#include <vector>

namespace palpate::testing {

/// From -1 to 1.
template <typename Number>
std::vector<Number> numbers(std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<Number> number(-1, 1);
  std::vector<Number> out(count);
  for (Number& x : out) x = number(random);
  return out;
}

}  // namespace palpate::testing
