// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/data/model_view.h"
#include "core/data/packed_modes.h"
#include "core/model/meta_model.h"

namespace palpate::bench {

/// The arrays of a model that hold the modes X_k as a tick reads them, each in its precision: as many bytes as
/// SeparatedField::bytes() says.
[[nodiscard]] inline std::vector<std::span<const std::byte>> modeStorage(const MetaModel& model) {
  const ModelView& view = model.view();
  const std::size_t plain = model.farField().counts().f32 * 3 * view.surfaceNodes();
  const PackedModes& packed = view.modes_packed;
  return {std::as_bytes(view.modes_X.first(plain)), std::as_bytes(packed.X16), std::as_bytes(packed.X8)};
}

}  // namespace palpate::bench
