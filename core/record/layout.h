// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/record/byte_stream.h"

namespace palpate::record {

/// First bytes of the file.
inline constexpr std::array<std::uint8_t, 8> kMagic{'P', 'A', 'L', 'P', 'R', 'E', 'C', 0x1A};
inline constexpr std::uint32_t kVersion = 7;

/// Kinds of block; each begins with its kind, the size of its content and the content's CRC-32.
inline constexpr std::uint32_t kHeaderBlock = 0x44414548;  // "HEAD"
inline constexpr std::uint32_t kTicksBlock = 0x4B434954;   // "TICK"
inline constexpr std::uint32_t kEndBlock = 0x21444E45;     // "END!"

inline constexpr std::size_t kFlushAt = 64 * 1024;         // bytes of content, then a block is written
inline constexpr std::size_t kLargestBlock = 1024 * 1024;  // a larger one is damage

struct BlockHead {
  std::uint32_t kind{0};
  std::uint32_t size{0};  ///< of the content, bytes
  std::uint32_t crc{0};
};
static_assert(sizeof(BlockHead) == 12);

}  // namespace palpate::record
