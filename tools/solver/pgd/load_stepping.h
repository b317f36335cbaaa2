// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace palpate::solver
