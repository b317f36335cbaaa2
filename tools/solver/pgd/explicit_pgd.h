// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/solver/pgd/level_solution.h"
#include "tools/solver/pgd/parametric_problem.h"

namespace palpate::solver {

/// How the increment D_s from t_{j-1} to t_j is linearized about u_s.            docs/design.md, Reproduction
enum class LoadStepping {
  kTenTerms,        ///< K_T(u_s) D_s = t_j l_s - f_int(u_s): Eq. (19), the residual carried over
  kForwardEuler,    ///< K_T(u_s) D_s = (t_j - t_{j-1}) l_s: Remark 2, no residual
  kConstantTangent  ///< K_T(0) D_s = t_j l_s - f_int(u_s)
};

/// When load stepping stops enriching, and its limits.
struct ExplicitOptions {
  LoadStepping scheme{LoadStepping::kTenTerms};
  int steps{100};  ///< equal load steps, >= 1

  /// Of each step's residual in the dual norm of K0, |.|^2 = . K0^-1 ., relative: |rho_s| / (t_j |l_s|) at the
  /// worst position, so positions near the clamp count like the others. With more than `exact_residuals`
  /// positions it is the root mean square over the positions. kForwardEuler carries no residual over; there
  /// it is relative to the step's own load. > 0.
  double tolerance{0.1};
  int max_pairs{300};             ///< largest number of columns of X, >= 1
  int sweeps{3};                  ///< of alternating directions per pair, >= 1
  int modes{0};                   ///< X kept in the result, 0 for all
  double level_tolerance{1e-10};  ///< of the level functions, relative
  int max_levels{119};            ///< level functions, >= 1
  int exact_residuals{500};       ///< with more positions than this, probes estimate the residual
  int probes{24};                 ///< random combinations of positions that estimate it, >= 1
  double tangent_bytes{1.5e9};    ///< for K_T(u_s) kept between passes; the others are assembled again
  int workers{0};                 ///< threads, 0 for all
  bool quiet{false};              ///< no progress line
};

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
