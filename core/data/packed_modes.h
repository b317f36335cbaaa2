// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate {

/// Numbers of a surface field in a tile.
inline constexpr std::size_t kTile = 64;

/// How a mode's numbers are kept for the tick: as they are, or as whole numbers with a scale.
enum class ModePrecision : std::uint8_t { kFloat32, kInt16, kBits10, kBits8 };
inline constexpr std::size_t kPackedKinds = 3;  ///< all but float32

/// Modes of int16, and modes in bytes, that a file may have: their weights (ModeSelection) add up to less than what an
/// integer holds by what rounding may add, and with more modes that would be more than an eighth of it.
inline constexpr std::size_t kMostPackedModes = 16384;

/// Scale of a mode that moves nothing.
inline constexpr float kLeastScale = 1e-30F;

/// How many modes of each kind there are, in the order of the file. All but the first two kinds are kept in bytes.
struct ModeCounts {
  std::size_t f32{0};
  std::size_t i16{0};
  std::size_t bits10{0};
  std::size_t bits8{0};

  [[nodiscard]] std::size_t inBytes() const noexcept { return bits10 + bits8; }
  [[nodiscard]] std::size_t packed() const noexcept { return i16 + inBytes(); }
  [[nodiscard]] std::size_t all() const noexcept { return f32 + packed(); }
  /// Pairs of int16 modes.
  [[nodiscard]] std::size_t pairs() const noexcept { return (i16 + 1) / 2; }
  /// Quads of bytes: first a byte of each mode, then, in quads of their own, the bytes that modes share.
  [[nodiscard]] std::size_t ownQuads() const noexcept { return (inBytes() + 3) / 4; }
  [[nodiscard]] std::size_t shared() const noexcept { return (bits10 + 3) / 4; }
  [[nodiscard]] std::size_t quads() const noexcept { return ownQuads() + (shared() + 3) / 4; }
};

/// The modes of a file in mixed precision, as the tick reads them; all empty where X is read instead.
/// Tiles of kTile numbers follow each other, the last one filled up, as many as it takes to hold every number that is
/// not zero in all modes: clamped nodes at the end of the surface need none.
/// An int16 mode's number is scale * what is stored. Bytes count from 128. A number of a mode in bytes is
/// scale * (own + share / 256 * shared): four modes of 10 bits share a byte, with shares 1, 4, 16 and 64. Modulo 1 the
/// shared byte adds two bits to each mode; the mode's own byte cancels the rest. So a field is a weighted sum of bytes, and
/// nothing is unpacked.
struct PackedModes {
  std::span<const std::int16_t> X16;    ///< [tiles][ceil(i16 / 2)][kTile][2]
  std::span<const std::uint8_t> X8;     ///< [tiles][quads][kTile][4]
  std::span<const float> scale;         ///< [i16 + bits10 + bits8]
  std::span<const std::int32_t> kinds;  ///< [kPackedKinds] how many modes have 16, 10 and 8 bits
  std::size_t tiles{0};                 ///< at most tilesOf(3 Ns)

  [[nodiscard]] bool empty() const noexcept { return scale.empty(); }
};

[[nodiscard]] constexpr std::size_t tilesOf(std::size_t numbers) noexcept {
  return (numbers + kTile - 1) / kTile;
}

/// @param modes  n, at least as many as are packed
[[nodiscard]] ModeCounts countModes(const PackedModes& packed, std::size_t modes) noexcept;

/// Of a mode in bytes: which shared byte it has, and how much of it.
struct SharedByte {
  std::size_t slot;  ///< byte in all quads of a tile, from 4 * ownQuads() on
  int share;         ///< of 256; 0: none
};
/// @param row  of the modes in bytes, 0 to inBytes() - 1
[[nodiscard]] inline SharedByte sharedByte(const ModeCounts& counts, std::size_t row) noexcept {
  const std::size_t first = 4 * counts.ownQuads();
  return row < counts.bits10 ? SharedByte{first + row / 4, 1 << (2 * (row % 4))} : SharedByte{first, 0};
}

/// Number i of a mode that is not float32. @param mode  of the file, counts.f32 to n - 1  @param i  below 3 Ns
[[nodiscard]] float unpack(const PackedModes& packed, const ModeCounts& counts, std::size_t mode,
                           std::size_t i) noexcept;

/// The largest rounding error of a number of a mode that is not float32.
[[nodiscard]] float roundingOf(const PackedModes& packed, const ModeCounts& counts,
                               std::size_t mode) noexcept;

}  // namespace palpate
