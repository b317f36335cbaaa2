// SPDX-License-Identifier: Apache-2.0
#include "crc32.h"

#include <array>

namespace palpate::record {
namespace {

constexpr std::array<std::uint32_t, 256> makeTable() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) {
      const bool carry = (remainder & 1U) != 0;
      remainder = (remainder >> 1) ^ (carry ? 0xEDB88320U : 0U);
    }
    table[byte] = remainder;
  }
  return table;
}

constexpr auto kTable = makeTable();

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes) noexcept {
  std::uint32_t remainder = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) remainder = kTable[(remainder ^ byte) & 0xFFU] ^ (remainder >> 8);
  return ~remainder;
}

}  // namespace palpate::record
