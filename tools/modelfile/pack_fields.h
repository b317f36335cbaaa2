// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/modelfile/model_data.h"

namespace palpate::modelfile {

/// Whole numbers with a scale for each block: number = scale * whole.
struct PackedNumbers {
  float most{32767.0F};  ///< what the largest number of a block becomes
  std::vector<std::int16_t> whole;
  std::vector<float> scale;  ///< > 0; infinity or NaN where the block has one

  /// Adds a block: the rounding is at most half its scale.
  void add(std::span<const float> block);
};

/// The fields as the file has them (docs/model_file.md): X node by node with a scale for each mode, Y and the near field
/// coefficient by coefficient of each position or edge, that of nodal Green's functions node by node with a scale for each load.
/// Modes are scaled so that the largest amplitude of each is the same.
struct PackedFields {
  PackedNumbers X, Y, near, green_Y, green_near, edges;
};

/// Of compact data whole numbers are of 8 bits, -127 to 127.
/// @param data  of sizes that fit each other
[[nodiscard]] PackedFields packFields(const ModelData& data);

}  // namespace palpate::modelfile
