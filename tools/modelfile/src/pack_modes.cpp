// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "palpate/modelfile/mixed_precision.h"

namespace palpate::modelfile {

namespace {

float largest(std::span<const float> values) {
  float most = 0.0F;
  for (const float value : values) most = std::max(most, std::abs(value));
  return most;
}

/// A power of two, so that scaling rounds nothing; the largest number becomes 0.5 to 1.
float halfScale(std::span<const float> mode) {
  int exponent = 0;
  (void)std::frexp(largest(mode), &exponent);
  return std::ldexp(1.0F, std::clamp(exponent, -120, 120));
}

float int8Scale(std::span<const float> mode) {
  const float scale = largest(mode) / 127.0F;
  return scale > 1e-30F ? scale : 1.0F;
}

std::int8_t rounded(float number) {
  return static_cast<std::int8_t>(std::clamp(std::nearbyint(number), -128.0F, 127.0F));
}

}  // namespace

void packModes(std::span<const float> X, std::size_t numbers, const ModeCounts& counts, ModelData& data) {
  const std::size_t tiles = tilesOf(numbers), quads = (counts.i8 + 3) / 4;
  data.modes_X16.assign(tiles * counts.f16 * kTile, 0);
  data.modes_X8.assign(tiles * quads * kTile * 4, 0);
  data.modes_scale.clear();
  for (std::size_t row = 0; row < counts.f16 + counts.i8; ++row) {
    const std::span<const float> mode = X.subspan((counts.f32 + row) * numbers, numbers);
    const float scale = row < counts.f16 ? halfScale(mode) : int8Scale(mode);
    data.modes_scale.push_back(scale);
    for (std::size_t i = 0; i < numbers; ++i) {
      const std::size_t tile = i / kTile, place = i % kTile;
      const float number = mode[i] / scale;
      if (row < counts.f16) {
        data.modes_X16[(tile * counts.f16 + row) * kTile + place] = toHalf(number);
        continue;
      }
      const std::size_t lane = row - counts.f16;
      std::int8_t* const quad = data.modes_X8.data() + ((tile * quads + lane / 4) * kTile + place) * 4;
      const std::size_t k =
          lane % 4;  // b and d are rounded knowing a and c, which count as what follows the point
      const auto below =
          k % 2 == 0 ? 0.0F : static_cast<float>(static_cast<std::uint8_t>(quad[k - 1])) / 256.0F;
      quad[k] = rounded(number - below);
    }
  }
}

}  // namespace palpate::modelfile
