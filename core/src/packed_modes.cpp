// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/packed_modes.h"

#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

constexpr int kHalfDigits = 11;      // of a normal half, the leading one with them
constexpr int kLeastExponent = -14;  // of a normal half
constexpr float kLargestHalf = 65504.0F;

}  // namespace

ModeCounts countModes(const PackedModes& packed, std::size_t modes, std::size_t numbers) noexcept {
  const std::size_t tile_numbers = tilesOf(numbers) * kTile;
  if (packed.empty() || tile_numbers == 0) return {modes, 0, 0};
  ModeCounts counts;
  counts.f16 = packed.X16.size() / tile_numbers;
  counts.i8 = packed.scale.size() - std::min(counts.f16, packed.scale.size());
  counts.f32 = modes - std::min(modes, counts.f16 + counts.i8);
  return counts;
}

float unpack(const PackedModes& packed, const ModeCounts& counts, std::size_t mode, std::size_t i) noexcept {
  const std::size_t tile = i / kTile, place = i % kTile, row = mode - counts.f32;
  const float scale = packed.scale[row];
  if (row < counts.f16) return scale * fromHalf(packed.X16[(tile * counts.f16 + row) * kTile + place]);
  const std::size_t quads = (counts.i8 + 3) / 4, lane = row - counts.f16;
  const std::int8_t* const quad = packed.X8.data() + ((tile * quads + lane / 4) * kTile + place) * 4;
  const auto number = static_cast<float>(quad[lane % 4]);
  if (lane % 2 == 0) return scale * number;
  return scale * (number + static_cast<float>(static_cast<std::uint8_t>(quad[lane % 4 - 1])) / 256.0F);
}

float fromHalf(std::uint16_t half) noexcept {
  const float sign = (half & 0x8000U) != 0 ? -1.0F : 1.0F;
  const int exponent = (half >> 10U) & 0x1F;
  const auto mantissa = static_cast<float>(half & 0x3FFU);
  if (exponent == 0x1F) return sign * (mantissa == 0.0F ? HUGE_VALF : NAN);
  if (exponent == 0) return sign * std::ldexp(mantissa, kLeastExponent - 10);
  return sign * std::ldexp(1024.0F + mantissa, exponent - 25);
}

std::uint16_t toHalf(float value) noexcept {
  const auto sign = static_cast<std::uint16_t>(std::signbit(value) ? 0x8000U : 0U);
  const float size = std::abs(value);
  if (std::isnan(value)) return static_cast<std::uint16_t>(sign | 0x7E00U);
  int exponent = 0;
  (void)std::frexp(size, &exponent);  // size = m 2^exponent, m in [0.5, 1)
  exponent = size > 0.0F ? std::max(exponent - 1, kLeastExponent) : kLeastExponent;
  const float steps = std::nearbyint(std::ldexp(size, kHalfDigits - 1 - exponent));
  if (!(std::ldexp(steps, exponent - kHalfDigits + 1) <= kLargestHalf))
    return static_cast<std::uint16_t>(sign | 0x7C00U);
  // A carry of the mantissa into the exponent is right by itself, from subnormal to normal too.
  const int biased = exponent - kLeastExponent;
  return static_cast<std::uint16_t>(sign |
                                    (static_cast<unsigned>(biased) * 1024U + static_cast<unsigned>(steps)));
}

float roundingBound(ModePrecision precision, float x, float scale) noexcept {
  switch (precision) {
    case ModePrecision::kFloat32:
      return 0.0F;
    case ModePrecision::kFloat16:
      return std::max(std::ldexp(std::abs(x), -kHalfDigits), std::ldexp(scale, kLeastExponent - kHalfDigits));
    case ModePrecision::kInt8:
      return 0.5F * scale;
  }
  return 0.0F;
}

}  // namespace palpate
