// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/meta_model.h"

namespace palpate {

/// K_max, the largest stiffness that a tool meets within the model's domain, at the model's own E: the largest eigenvalue of
/// df/dd over the accessible contact positions, at rest and at d_max in nine directions, straight in, four at 45 degrees and
/// four along the surface. Of load-driven models at f_max in these directions of f, or at t_max.  docs/design.md, Contact
/// A sample, not a bound: between positions and directions a place may be stiffer.
/// @return N/m; infinity where a number overflows. Cost ten answers for each position. Real-time: no. Threads: const.
[[nodiscard]] double largestStiffness(const MetaModel& model);

}  // namespace palpate
