// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/model/meta_model.h"

namespace palpate::testing {

inline Vec3 nodePosition(const MetaModel& model, std::int32_t node) {
  return Eigen::Map<const Vec3>(model.view().surface_positions.data() + 3 * node);
}

/// What a tool at s touches.
inline PatchNodes patchAt(const MetaModel& model, const ContactPoint& s) {
  PatchNodes patch = model.patches().room();
  model.patches().at(s, false, patch);
  return patch;
}

}  // namespace palpate::testing
