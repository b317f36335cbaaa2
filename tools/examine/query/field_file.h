// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/model/meta_model.h"
#include "tools/examine/query/answer.h"
#include "tools/examine/query/full_solution.h"

namespace palpate::query {

/// The rest surface as VTK XML (.vtu, triangles, m) with the point data `displacement` (of the model) and
/// `mesh_tag`, and with a full solution `newton` (its displacement) and `error` (displacement - newton).
/// @param organ, truth  both or neither
[[nodiscard]] std::string fieldVtu(const MetaModel& model, const Answer& answer, const Organ* organ,
                                   const FullSolution* truth);

}  // namespace palpate::query
