// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "palpate/query/answer.h"
#include "palpate/query/full_solution.h"

namespace palpate::query {

/// The rest surface as VTK XML (.vtu, triangles, m) with the point data `displacement` (of the model) and
/// `mesh_tag`, and with a full solution `newton` (its displacement) and `error` (displacement - newton).
/// @param organ, truth  both or neither
[[nodiscard]] std::string fieldVtu(const MetaModel& model, const Answer& answer, const Organ* organ,
                                   const FullSolution* truth);

/// Writes beside the target and renames, so that nobody reads half a file.
/// @throw QueryError naming the file and the reason
void writeText(const std::filesystem::path& path, const std::string& text);

}  // namespace palpate::query
