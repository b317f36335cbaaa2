// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "palpate/core/mode_selection.h"

namespace palpate {

/// Modes as the tick reads them (core/README.md, "Modes in mixed precision"): tiles of kTile numbers of a surface
/// field, one after the other; in each the rows of all float16 modes, and of all int8 modes four by four.
struct ModeTiles {
  const std::uint16_t* X16;  ///< [tiles][rows16][kTile] IEEE 754 half
  std::size_t rows16;
  const std::int8_t* X8;  ///< [tiles][quads8][kTile][4]
  std::size_t quads8;
};

/// What of the modes is added, and how much.
struct TileWeights {
  const std::uint32_t* row16;  ///< [count16] which rows
  const float* weight16;       ///< [count16]
  std::size_t count16;
  const std::uint32_t* quad8;  ///< [count8] which quads
  const QuadWeights* weight8;  ///< [count8] the sum of all their amounts is at most 65535
  std::size_t count8;
  float unit8;  ///< what a product of 1 is worth; a number of a mode counts 256 times
};

/// u[i] += the weighted sum of the modes at i, i < length. Each tile of u stays in registers while the modes stream
/// past once; int8 modes are summed in whole numbers, two products an instruction. Real-time: yes.
void addTiles(const ModeTiles& modes, const TileWeights& weights, std::size_t length,
              float* u) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
