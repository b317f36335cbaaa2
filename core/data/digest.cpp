// SPDX-License-Identifier: Apache-2.0
#include "core/data/sha256.h"

namespace palpate {

std::string Digest::hex() const {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) (text += kDigits[byte >> 4U]) += kDigits[byte & 15U];
  return text;
}

std::string Digest::id() const {
  constexpr std::size_t kDigits = 40;  // 160 bits
  return hex().substr(0, kDigits);
}

std::uint64_t Digest::leading64() const noexcept {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i) value = value << 8U | bytes[i];
  return value;
}

Digest sha256(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.finish();
}

}  // namespace palpate
