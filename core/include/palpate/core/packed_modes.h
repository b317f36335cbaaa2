// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate {

/// Numbers of a surface field in a tile.
inline constexpr std::size_t kTile = 64;

/// How a mode's numbers are kept for the tick: as they are, or as whole numbers with a scale.
enum class ModePrecision : std::uint8_t { kFloat32, kInt16, kInt8 };

/// How many modes of each kind there are, in the order of the file: float32 first, int8 last.
struct ModeCounts {
  std::size_t f32{0};
  std::size_t i16{0};
  std::size_t i8{0};

  [[nodiscard]] std::size_t pairs() const noexcept { return (i16 + 1) / 2; }
  [[nodiscard]] std::size_t quads() const noexcept { return (i8 + 3) / 4; }
};

/// The modes of a file in mixed precision, as the tick reads them; all empty where X is read instead.
/// For modes f32 .. n - 1, a number of a mode is scale * what is stored. Tiles of kTile numbers follow each other, the
/// last one filled up with zeros; tiles = ceil(3 Ns / kTile).
/// In a quad of int8 modes a, b, c, d the sixteen bits that hold a and b are 256 times the number of b as they stand,
/// and 256 times that of a when they are moved up by eight: b is rounded knowing a, and is as exact.
struct PackedModes {
  std::span<const std::int16_t> X16;  ///< [tiles][ceil(i16 / 2)][kTile][2]
  std::span<const std::int8_t> X8;    ///< [tiles][ceil(i8 / 4)][kTile][4]
  std::span<const float> scale16;     ///< [i16]
  std::span<const float> scale8;      ///< [i8]

  [[nodiscard]] bool empty() const noexcept { return scale16.empty() && scale8.empty(); }
};

[[nodiscard]] constexpr std::size_t tilesOf(std::size_t numbers) noexcept {
  return (numbers + kTile - 1) / kTile;
}

/// @param modes  n, at least as many as are packed
[[nodiscard]] inline ModeCounts countModes(const PackedModes& packed, std::size_t modes) noexcept {
  const std::size_t i16 = packed.scale16.size(), i8 = packed.scale8.size();
  return {modes - i16 - i8, i16, i8};
}

/// Number i of a mode that is not float32. @param mode  of the file, counts.f32 to n - 1  @param i  below 3 Ns
[[nodiscard]] float unpack(const PackedModes& packed, const ModeCounts& counts, std::size_t mode,
                           std::size_t i) noexcept;

/// The scale of a mode that is not float32: half of it is the largest rounding error of a number.
[[nodiscard]] float scaleOf(const PackedModes& packed, const ModeCounts& counts, std::size_t mode) noexcept;

}  // namespace palpate
