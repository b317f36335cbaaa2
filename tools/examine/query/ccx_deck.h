// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/examine/query/full_solution.h"

namespace palpate::query {

/// A number as CalculiX reads it: at most 20 characters, as exact as fits.
[[nodiscard]] std::string ccxNumber(double value);

/// The problem that Newton solved, as a CalculiX deck for anybody to check: NLGEOM, the law as its
/// MaterialLaw::ccx says it, the mesh's own node and element numbers, Newton's force spread over the
/// patch as nodal loads w_i f, U of all nodes in the .dat. SI units.
/// @param about  one line for the head of the deck  @param steps  load steps to begin with, >= 1
/// @throw QueryError naming a node or element whose number CalculiX cannot take
[[nodiscard]] std::string ccxDeck(const Organ& organ, const FullSolution& solution, const std::string& about,
                                  int steps);

}  // namespace palpate::query
