// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/data/checker.h"
#include "core/data/model_view.h"

namespace palpate {

/// /contact/triangles are /surface/triangles, or faces of quadratic elements: four of these each, as docs/model_file.md says,
/// with one node in the middle of each edge; and contact positions are their corners. Surface triangles and positions are in
/// range already.
/// @throw LoadError naming dataset and number
void checkFaces(const ModelView& v, const Checker& check);

}  // namespace palpate
