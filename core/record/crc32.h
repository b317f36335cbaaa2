// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <cstdint>
#include <span>

namespace palpate::record {

/// zlib's CRC-32, that of IEEE 802.3: finds every single flipped bit, and every burst of up to 32.
/// @param before  of the bytes before these
[[nodiscard]] inline std::uint32_t crc32(std::span<const std::uint8_t> bytes,
                                         std::uint32_t before = 0) noexcept {
  return static_cast<std::uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

}  // namespace palpate::record
