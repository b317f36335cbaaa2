// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/meta_model.h"
#include "tools/examine/query/answer.h"
#include "tools/program/length_unit.h"

namespace palpate::query {

/// Numbers that were asked for become a place or a displacement, judged by the organ's size: a slip of unit is told as such.

/// The nearest point of the rest surface to a place. Anchor::distance says how far it is.
/// @throw program::ValueError when the place lies farther from the surface than contactRadius()
[[nodiscard]] Anchor anchorOf(const MetaModel& model, const program::AskedPlace& place);

/// Longest displacement that can mean a touch of this organ, m: ten times the largest r_max, at least a tenth of the organ from
/// corner to corner; that whole length for load-driven models, which have no r_max.
[[nodiscard]] double longestDisplacement(const MetaModel& model);

/// The displacement in metres. @param asked  its numbers, as they were asked for
/// @throw program::ValueError naming its length, the longest, and the units in which it would be a touch
[[nodiscard]] Vec3 displacementOf(const MetaModel& model, const program::AskedPlace& asked);

}  // namespace palpate::query
