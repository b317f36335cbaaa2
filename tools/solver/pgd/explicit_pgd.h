// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/solver/pgd/level_solution.h"
#include "tools/solver/pgd/load_stepping.h"
#include "tools/solver/pgd/parametric_problem.h"

namespace palpate::solver {

/// Load stepping in separated form: one PGD for all load positions, enriched at each load step.
///   u(X, s, t) = sum_k X_k(X) Y_k(s, t)                                         paper Section 3, Eq. (19)
/// At each step the increment is D_s = X y_s. All Y of the step solve the Galerkin systems
/// X^T K_T(u_s) X y_s = X^T r_s; while the residual rho_s = r_s - K_T(u_s) X y_s is above the tolerance a pair
/// (R, S) is added by alternating directions:
///   S_s = R . rho_s / R . K_T(u_s) R,    (sum_s v_s S_s^2 K_T(u_s)) R = sum_s v_s S_s rho_s,
/// with v_s = w_s / (l_s . K0^-1 l_s), and all Y are solved for again. A pair born at step j is zero up to
/// t_{j-1}.
/// Differs from the paper: a step adds no R while the X of earlier steps suffice, and Y of every pair changes
/// with the load. No position is solved nonlinearly by itself: u_s, K_T(u_s) and r_s are integrands over s.
/// The weights v_s cost one linear solve per position at the start. An exact residual costs one solve with K0
/// per position and pair.
/// With more than `exact_residuals` positions the residual is the mean over Gaussian combinations of
/// positions (relative spread of the norm at most 1 / sqrt(2 probes)).
/// @throw std::invalid_argument naming the option out of range, std::runtime_error with the level at which it
/// is no longer finite.
/// Cost per step and position: one tangent, its product with X, n^2 dofs; per pair about sweeps + 2 products
/// with K_T(u_s) and `sweeps` factorizations. Memory: tangent_bytes + M n^2 + steps n M + dofs M doubles.
[[nodiscard]] LevelSolution solveExplicit(const ParametricProblem& problem, const ExplicitOptions& options);

}  // namespace palpate::solver
