// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/meta_model.h"

namespace palpate {

/// How far from the surface a place may lie that means a point of it, m: the patch's radius a; of nodal loads, whose a is tiny,
/// the mean edge of the surface. Cost O(T). Real-time: no.
[[nodiscard]] double contactRadius(const MetaModel& model);

}  // namespace palpate
