// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "palpate/core/multi_index.h"
#include "palpate/offline/cholesky.h"
#include "palpate/offline/fe_model.h"
#include "palpate/offline/patch.h"

namespace palpate::offline {

/// Sampling and limits of the domain radius d_max(s).                                          DESIGN 2.2
struct DomainCriteria {
  double force_error{0.01};  ///< last terms of the force, and estimated remainder, relative to the force
  double min_det_f{0.3};     ///< over all elements
  double cap{0.05};          ///< m, largest radius ever stated
};

/// The displacement-driven series of up to kLanes contact positions at once.                   DESIGN 2.2
///   u(X; s, d) = sum d^alpha U_alpha(X, s),  f(s, d) = sum d^alpha f_alpha(s),  1 <= |alpha| <= p
/// One factorization K0 = K_T(0) serves every position, direction and order. Coefficients are not scaled:
/// U_alpha in m^(1-|alpha|), f_alpha in N m^-|alpha|. One object per thread; the factor is shared.
class SeriesSolver {
 public:
  /// @param factor  of K_T(0)  @param order  p, 1 to MonomialBasis::kMaxOrder
  SeriesSolver(const FeModel& model, const Cholesky& factor, int order);
  ~SeriesSolver();

  /// @param patches  1 to kLanes contact patches with at least one free node each
  /// @throw std::runtime_error when a patch cannot be moved (C_s singular) or a result is not finite
  void solve(std::span<const Patch> patches);

  /// Degree of the force for fields of degree p: 2p, as far as the energy (one degree more) stays in a
  /// MonomialBasis.
  [[nodiscard]] static constexpr int forceOrder(int order) noexcept {
    return std::max(order, std::min(2 * order, MonomialBasis::kMaxOrder - 1));
  }

  /// The monomials of the fields, degree p.
  [[nodiscard]] const MonomialBasis& basis() const noexcept;
  /// The monomials of the force, degree forceOrder(p).
  [[nodiscard]] const MonomialBasis& forceBasis() const noexcept;
  /// f_alpha of the position in a lane, alpha = forceBasis()[k]; N m^-|alpha|.
  [[nodiscard]] Vec3 force(int lane, int k) const;
  /// U_alpha of the position in a lane at a volume node; m^(1-|alpha|).
  [[nodiscard]] Vec3 displacement(int lane, int k, int node) const;
  /// Largest |d| at which the series of a lane is to be trusted, over 26 directions, m.
  [[nodiscard]] std::vector<double> domainRadii(const DomainCriteria& criteria) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::offline
