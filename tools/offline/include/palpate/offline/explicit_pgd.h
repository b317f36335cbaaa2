// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/offline/level_solution.h"
#include "palpate/offline/parametric_problem.h"

namespace palpate::offline {

/// How the increment D_s from t_{j-1} to t_j is linearized about u_s.            docs/design.md, Reproduction
enum class LoadStepping {
  kTenTerms,        ///< K_T(u_s) D_s = t_j l_s - f_int(u_s): Eq. (19), the residual carried over
  kForwardEuler,    ///< K_T(u_s) D_s = (t_j - t_{j-1}) l_s: Remark 2, no residual
  kConstantTangent  ///< K_T(0) D_s = t_j l_s - f_int(u_s)
};

/// Where the walk over the load stops enriching, and what it may take.
struct ExplicitOptions {
  LoadStepping scheme{LoadStepping::kTenTerms};
  int steps{100};  ///< equal load steps, >= 1

  /// Of each step's residual in the dual norm of K0, |.|^2 = . K0^-1 ., relative: |rho_s| / (t_j |l_s|) at the
  /// worst position, so that positions beside the clamp count like others; beyond `exact_residuals` the root
  /// mean square over the positions. Without the residual carried over (kForwardEuler) relative to the step's
  /// own load. > 0.
  double tolerance{0.1};
  int max_pairs{300};             ///< X never grows beyond, >= 1
  int sweeps{3};                  ///< of alternating directions a pair, >= 1
  int modes{0};                   ///< X kept in the result, 0 for all
  double level_tolerance{1e-10};  ///< of the level functions, relative
  int max_levels{119};            ///< level functions, >= 1
  int exact_residuals{500};       ///< up to so many positions the residual is exact; beyond, from probes
  int probes{24};                 ///< random combinations of positions that estimate it, >= 1
  double tangent_bytes{1.5e9};    ///< K_T(u_s) kept from pass to pass; those beyond are assembled again
  int workers{0};                 ///< threads, 0 for all
  bool quiet{false};              ///< no progress line
};

/// Load stepping in separated form: one PGD for all load positions, enriched at each load step.
///   u(X, s, t) = sum_k X_k(X) Y_k(s, t)                                         paper Section 3, Eq. (19)
/// At each step the increment is D_s = X y_s. All Y of the step come from the Galerkin systems
/// X^T K_T(u_s) X y_s = X^T r_s; while the residual rho_s = r_s - K_T(u_s) X y_s is above the tolerance a pair
/// (R, S) is added by alternating directions:
///   S_s = R . rho_s / R . K_T(u_s) R,    (sum_s v_s S_s^2 K_T(u_s)) R = sum_s v_s S_s rho_s,
/// with v_s = w_s / (l_s . K0^-1 l_s), and all Y follow again. A pair born at step j is zero up to t_{j-1}.
/// Differs from the paper: R is not a new function of each step when those there are do; Y of every pair goes
/// on with the load. No position is ever solved nonlinearly by itself; what is evaluated for each s, u_s, K_T(u_s),
/// r_s, are the integrands over s. The weights v_s take one linear solve a position at the start, and the residual,
/// as long as it is exact, one with K0 for each position and pair.
/// Of positions beyond `exact_residuals`, the residual is the mean over Gaussian combinations of positions
/// (relative spread of the norm at most 1 / sqrt(2 probes)).
/// @throw std::invalid_argument naming the option out of range, std::runtime_error with the level where the
///   solution stops being finite
/// Cost per step and position: one tangent, its product with X, n^2 dofs; per pair about sweeps + 2 products
/// with K_T(u_s) and `sweeps` factorizations. Memory: tangent_bytes + M n^2 + steps n M + dofs M doubles.
[[nodiscard]] LevelSolution solveExplicit(const ParametricProblem& problem, const ExplicitOptions& options);

}  // namespace palpate::offline
