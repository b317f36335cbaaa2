// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "palpate/core/model_view.h"

namespace palpate::bench {

/// The arrays of a model that hold the modes X_k, in whatever precision: what a field evaluation streams through.
[[nodiscard]] inline std::vector<std::span<const std::byte>> modeStorage(const ModelView& view) {
  return {std::as_bytes(view.modes_X)};
}

}  // namespace palpate::bench
