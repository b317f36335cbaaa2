// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "core/data/packed_modes.h"
#include "tools/modelfile/model_data.h"

namespace palpate::modelfile {

/// Modes in 16, 10 or 8 bits with a scale each, as the tick reads them.
/// @param X  modes in the order of the file, of which those from counts.f32 on are packed  @param numbers  3 Ns
[[nodiscard]] PackedModesData packModes(std::span<const float> X, std::size_t numbers,
                                        const ModeCounts& counts);

}  // namespace palpate::modelfile
