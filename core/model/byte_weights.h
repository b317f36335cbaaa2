// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/types.h"

namespace palpate {

/// Arrays of weighPairs() have room for a multiple of this many.
inline constexpr std::size_t kPairBlock = 64;
[[nodiscard]] constexpr std::size_t pairBlocks(std::size_t pairs) noexcept {
  return (pairs + kPairBlock - 1) / kPairBlock * kPairBlock;
}

/// Amplitudes of pairs of bytes, and what they are weighed with. What lies between the number of pairs and the next
/// multiple of kPairBlock is written as well.
struct BytePairs {
  float* even;           ///< amplitude of each pair's first byte; what the weights leave of it
  float* odd;            ///< of its second one
  float* left;           ///< the larger amount of the two that are left
  std::int16_t* bytes;   ///< the weights of both, the first one in the lower byte
  std::int16_t* weight;  ///< of the pair: 0 to 32767
};

/// Sum and maximum of |x|. NaN makes the sum NaN.
struct Amounts {
  float sum, most;
};
/// @param length  a multiple of kPairBlock. Real-time: yes.
[[nodiscard]] Amounts amountsOf(const float* x, std::size_t length) noexcept PALPATE_NONBLOCKING;

/// Least weight of a pair's larger byte.
inline constexpr float kLeastByte = 49.0F;

/// amplitude ~ unit * weight * byte for both bytes of each pair. Of the weights p >= q of the bytes, p + q at most 128,
/// p is the one of the sixteen largest that comes nearest to the amplitudes' ratio with a whole q.
/// @param unit  at least any amplitude / (kLeastByte * 32767)
/// @return sum of weight * (first + second), which may wrap round. Real-time: yes.
std::int32_t weighPairs(const BytePairs& pairs, std::size_t count, float unit) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
