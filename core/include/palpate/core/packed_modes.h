// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "palpate/core/model_view.h"

namespace palpate {

/// Numbers of a surface field in a tile.
inline constexpr std::size_t kTile = 64;

/// How a mode's numbers are kept for the tick.
enum class ModePrecision : std::uint8_t { kFloat32, kFloat16, kInt8 };

/// How many modes of each kind there are, in the order of the file: float32 first, int8 last.
struct ModeCounts {
  std::size_t f32{0};
  std::size_t f16{0};
  std::size_t i8{0};
};

/// The modes of a file in mixed precision, as the tick reads them; all empty where X is read instead.
/// For modes f32 .. n - 1, a number of a mode is scale * what is stored. Tiles of kTile numbers follow each other, the
/// last one filled up with zeros; tiles = ceil(3 Ns / kTile).
/// In a quad of int8 modes a, b, c, d the sixteen bits that hold a and b are 256 times the number of b as they stand,
/// and 256 times that of a when they are moved up by eight: b is rounded knowing a, and is as exact.
struct PackedModes {
  std::span<const std::uint16_t> X16;  ///< [tiles][f16][kTile] IEEE 754 half
  std::span<const std::int8_t> X8;     ///< [tiles][ceil(i8 / 4)][kTile][4]
  std::span<const float> scale;        ///< [f16 + i8]

  [[nodiscard]] bool empty() const noexcept { return scale.empty(); }
};

[[nodiscard]] constexpr std::size_t tilesOf(std::size_t numbers) noexcept {
  return (numbers + kTile - 1) / kTile;
}

/// @param modes  n, @param numbers  3 Ns. Of sizes that fit each other; else any counts.
[[nodiscard]] ModeCounts countModes(const PackedModes& packed, std::size_t modes,
                                    std::size_t numbers) noexcept;

/// Number i of a mode that is not float32. @param mode  of the file, counts.f32 to n - 1  @param i  below 3 Ns
[[nodiscard]] float unpack(const PackedModes& packed, const ModeCounts& counts, std::size_t mode,
                           std::size_t i) noexcept;

/// Half to float and back, to the nearest, ties to even; more than 65504 becomes infinite.
[[nodiscard]] float fromHalf(std::uint16_t half) noexcept;
[[nodiscard]] std::uint16_t toHalf(float value) noexcept;

/// The largest error of a stored number x of a mode: half a step of its kind. @param scale  of the mode
[[nodiscard]] float roundingBound(ModePrecision precision, float x, float scale) noexcept;

}  // namespace palpate
