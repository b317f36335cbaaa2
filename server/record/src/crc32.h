// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace palpate::record {

/// CRC-32 of IEEE 802.3 (reflected polynomial 0xEDB88320): finds every single flipped bit, and every burst of up to 32.
[[nodiscard]] std::uint32_t crc32(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace palpate::record
