// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace palpate::bench {

/// Registers load/default: from a model file in the system's cache to a model that step() can use.
void registerLoad(const std::filesystem::path& model);

}  // namespace palpate::bench
