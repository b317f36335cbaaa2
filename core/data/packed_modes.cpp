// SPDX-License-Identifier: Apache-2.0
#include "core/data/packed_modes.h"

namespace palpate {

ModeCounts countModes(const PackedModes& packed, std::size_t modes) noexcept {
  if (packed.kinds.size() != kPackedKinds) return {modes, 0, 0, 0};
  const auto of = [&](std::size_t kind) { return static_cast<std::size_t>(packed.kinds[kind]); };
  ModeCounts counts{0, of(0), of(1), of(2)};
  counts.f32 = modes - counts.packed();
  return counts;
}

float unpack(const PackedModes& packed, const ModeCounts& counts, std::size_t mode, std::size_t i) noexcept {
  const std::size_t tile = i / kTile, place = i % kTile;
  if (tile >= packed.tiles) return 0.0F;
  std::size_t row = mode - counts.f32;
  const float scale = packed.scale[row];
  if (row < counts.i16) {
    const std::size_t pair = (tile * counts.pairs() + row / 2) * kTile + place;
    return scale * static_cast<float>(packed.X16[2 * pair + row % 2]);
  }
  row -= counts.i16;
  const auto byte = [&](std::size_t slot) {
    return packed.X8[((tile * counts.quads() + slot / 4) * kTile + place) * 4 + slot % 4] - 128;
  };
  const SharedByte shared = sharedByte(counts, row);
  const int below = shared.share == 0 ? 0 : shared.share * byte(shared.slot);
  return scale * static_cast<float>(256 * byte(row) + below) / 256.0F;
}

float roundingOf(const PackedModes& packed, const ModeCounts& counts, std::size_t mode) noexcept {
  const std::size_t row = mode - counts.f32;
  const bool bits10 = row >= counts.i16 && row < counts.i16 + counts.bits10;
  const float steps = bits10 ? 0.125F : 0.5F;
  return steps * packed.scale[row];
}

}  // namespace palpate
