// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate {

/// A count or number (i32, i64; never negative) as an index or a size of the standard library.
[[nodiscard]] constexpr std::size_t index(std::int64_t i) noexcept {
  return static_cast<std::size_t>(i);
}

}  // namespace palpate
