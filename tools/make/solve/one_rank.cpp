// SPDX-License-Identifier: Apache-2.0
// Of a program that is built without MPI.
#include "tools/make/solve/start_ranks.h"

namespace palpate::solve_program {

const solver::Ranks& startRanks() {
  return solver::Ranks::one();
}

void endRanks(int /*code*/) {}

}  // namespace palpate::solve_program
