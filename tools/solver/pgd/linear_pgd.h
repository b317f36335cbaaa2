// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/solver/pgd/linear_pgd_options.h"
#include "tools/solver/pgd/parametric_problem.h"
#include "tools/solver/pgd/separated_solution.h"

namespace palpate::solver {

/// Components of the unknowns of a body: x, y, z in turn.
[[nodiscard]] std::vector<int> bodyComponents(int dofs);

/// Linear parametric PGD: K u_s = l_s for all s at once, by greedy enrichment with alternating directions;
/// no full solution at a load position is ever formed.                      paper Eqs. (1)-(12), docs/design.md, Reproduction
/// Differs from the paper: a pair stops when it changes little, and the enrichment when the energy norm of
/// the residual is small. Pairs may be iterated in blocks, and a Galerkin step may update all Y for fixed X.
/// Solutions for a few random combinations of the loads estimate the residual's dual norm (the energy norm of
/// the error) without bias; EnrichmentStep::spread is the estimate's standard deviation. With a truncated
/// load it is the norm for that load.
/// @throw std::invalid_argument naming the option that is out of range, std::runtime_error when K is singular
/// Memory O((dofs + M) n). Cost per pair and sweep: one solve, O((dofs + M) n); Hadamard: one factorization.
[[nodiscard]] SeparatedSolution solveLinearPgd(const ParametricProblem& problem,
                                               const LinearPgdOptions& options);

}  // namespace palpate::solver
