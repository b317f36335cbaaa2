// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

namespace palpate::client {

/// A random first id for requests: never 0, and below 2^63, so that it may rise by one per request.
[[nodiscard]] inline std::uint64_t firstRequestId() {
  std::random_device random;
  return (static_cast<std::uint64_t>(random()) << 32 | random()) >> 1 | 1U;
}

}  // namespace palpate::client
