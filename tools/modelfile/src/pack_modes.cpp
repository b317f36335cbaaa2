// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "palpate/modelfile/mixed_precision.h"

namespace palpate::modelfile {

namespace {

/// So that the largest number becomes `top`.
float scaleOf(std::span<const float> mode, float top) {
  float most = 0.0F;
  for (const float value : mode) most = std::max(most, std::abs(value));
  const float scale = most / top;
  return scale > 1e-30F ? scale : 1.0F;
}

void packInt16(std::span<const float> mode, std::size_t row, const ModeCounts& counts, PackedModesData& to) {
  const float scale = scaleOf(mode, 32767.0F);
  to.scale16.push_back(scale);
  for (std::size_t i = 0; i < mode.size(); ++i) {
    const std::size_t pair = (i / kTile * counts.pairs() + row / 2) * kTile + i % kTile;
    const float number = std::clamp(std::nearbyint(mode[i] / scale), -32767.0F, 32767.0F);
    to.X16[2 * pair + row % 2] = static_cast<std::int16_t>(number);
  }
}

/// b and d are rounded knowing a and c, which count as what follows the point.
void packInt8(std::span<const float> mode, std::size_t row, const ModeCounts& counts, PackedModesData& to) {
  const float scale = scaleOf(mode, 127.0F);
  to.scale8.push_back(scale);
  for (std::size_t i = 0; i < mode.size(); ++i) {
    std::int8_t* const quad = to.X8.data() + ((i / kTile * counts.quads() + row / 4) * kTile + i % kTile) * 4;
    float number = mode[i] / scale;
    if (row % 2 == 1) number -= static_cast<float>(static_cast<std::uint8_t>(quad[row % 4 - 1])) / 256.0F;
    quad[row % 4] = static_cast<std::int8_t>(std::clamp(std::nearbyint(number), -128.0F, 127.0F));
  }
}

}  // namespace

PackedModesData packModes(std::span<const float> X, std::size_t numbers, const ModeCounts& counts) {
  PackedModesData packed;
  const std::size_t tiles = tilesOf(numbers);
  packed.X16.assign(tiles * counts.pairs() * kTile * 2, 0);
  packed.X8.assign(tiles * counts.quads() * kTile * 4, 0);
  for (std::size_t row = 0; row < counts.i16; ++row)
    packInt16(X.subspan((counts.f32 + row) * numbers, numbers), row, counts, packed);
  for (std::size_t row = 0; row < counts.i8; ++row)
    packInt8(X.subspan((counts.f32 + counts.i16 + row) * numbers, numbers), row, counts, packed);
  return packed;
}

}  // namespace palpate::modelfile
