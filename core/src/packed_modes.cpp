// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/packed_modes.h"

namespace palpate {

float unpack(const PackedModes& packed, const ModeCounts& counts, std::size_t mode, std::size_t i) noexcept {
  const std::size_t tile = i / kTile, place = i % kTile, row = mode - counts.f32;
  if (row < counts.i16) {
    const std::size_t pair = (tile * counts.pairs() + row / 2) * kTile + place;
    return packed.scale16[row] * static_cast<float>(packed.X16[2 * pair + row % 2]);
  }
  const std::size_t lane = row - counts.i16;
  const std::int8_t* const quad = packed.X8.data() + ((tile * counts.quads() + lane / 4) * kTile + place) * 4;
  const auto number = static_cast<float>(quad[lane % 4]);
  if (lane % 2 == 0) return packed.scale8[lane] * number;
  const auto below = static_cast<float>(static_cast<std::uint8_t>(quad[lane % 4 - 1])) / 256.0F;
  return packed.scale8[lane] * (number + below);
}

float scaleOf(const PackedModes& packed, const ModeCounts& counts, std::size_t mode) noexcept {
  const std::size_t row = mode - counts.f32;
  return row < counts.i16 ? packed.scale16[row] : packed.scale8[row - counts.i16];
}

}  // namespace palpate
