// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace palpate::organ {

/// Writes the case that goes with the default organ: healthy liver, and a nodule 13 times as stiff.
/// @param mesh  named in the case relative to it
/// @throw WriteError
void writeLiverCase(const std::filesystem::path& path, const std::filesystem::path& mesh);

}  // namespace palpate::organ
