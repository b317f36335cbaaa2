// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/plain_read.h"

#include <cstring>

namespace palpate::bench {

namespace {

using Words [[gnu::vector_size(32)]] = std::uint64_t;

}  // namespace

#if defined(PALPATE_HAVE_TARGET_CLONES)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
std::uint64_t
plainRead(std::span<const std::byte> bytes) noexcept {
  constexpr std::size_t kBlock = 8 * sizeof(Words);
  Words sum[8] = {};  // so that no addition waits for the previous one
  std::size_t i = 0;
  for (; i + kBlock <= bytes.size(); i += kBlock)
    for (std::size_t k = 0; k < 8; ++k) {
      Words words;
      std::memcpy(&words, bytes.data() + i + k * sizeof words, sizeof words);
      sum[k] += words;
    }
  std::uint64_t total = 0;
  for (const Words& words : sum) total += words[0] + words[1] + words[2] + words[3];
  for (; i < bytes.size(); ++i) total += std::to_integer<std::uint64_t>(bytes[i]);
  return total;
}

}  // namespace palpate::bench
