// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/model/mode_selection.h"

namespace palpate {

/// What of the packed modes is added, and how much: a ModeSelection, in plain numbers.
struct TileWeights {
  const std::uint32_t* pair16;  ///< [count16] which pairs
  const WeightPair* weight16;   ///< [count16]
  std::size_t count16;
  float unit16;
  const std::uint32_t* quad8;  ///< [count8] which quads
  const QuadWeights* weight8;  ///< [count8]
  std::size_t count8;
  float unit8;
  std::int32_t start8;  ///< what sums of products with bytes begin with, as bytes count from 128
};

/// u[i] = the weighted sum of the modes at i, i < length; zero beyond the last tile. The sums of a tile stay in
/// registers while its modes stream past once, in whole numbers: two products an instruction, of bytes four in two.
/// @param pairs, quads  how many of each a tile has  @param onto  add to u instead. Real-time: yes.
void sumTiles(const PackedModes& modes, std::size_t pairs, std::size_t quads, const TileWeights& weights,
              bool onto, std::span<float> u) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
