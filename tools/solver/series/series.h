// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/multi_index.h"
#include "tools/solver/fem/cholesky.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/fem/patch.h"
#include "tools/solver/series/series_orders.h"

namespace palpate::solver {

/// What a series is driven by, and what it answers.
enum class SeriesKind : std::uint8_t {
  kDisplacement,  ///< d prescribed, f found: the default method                      docs/design.md, Series
  kForce,  ///< f prescribed, d found: the paper's parameters, position and orientation   docs/design.md, Reproduction
};

/// How far the series of one position goes: |d|, m, or |f|, N.
struct SeriesRadii {
  double series;  ///< r_max, up to which the polynomials may run, or f_max
  double
      domain;  ///< d_max <= r_max, up to which the answer and the fields near the patch meet the criteria, or f_max
};

/// Sampling and limits of the domain radius d_max(s), or f_max(s).                     docs/design.md, Series
struct DomainCriteria {
  double answer_error{0.01};  ///< relative error of the force (or displacement) that the series may have
  double field_error{
      0.01};              ///< largest error of the fields near the patch, of |d|; driven by displacement only
  double min_det_f{0.3};  ///< over all integration points
  double series_error{0.2};    ///< of the force where the polynomials end; driven by displacement only
  double cap{kLargestRadius};  ///< m, largest radius; driven by force: of the linear answer
};

/// The series of up to kLanes contact positions at once.                               docs/design.md, Series
///   kDisplacement: u(X; s, d) = sum d^alpha U_alpha(X, s),  f(s, d) = sum d^alpha f_alpha(s)
///   kForce:        u(X; s, f) = sum f^alpha U_alpha(X, s),  d(s, f) = sum f^alpha d_alpha(s)
/// 1 <= |alpha| <= p for the fields. With f prescribed the recursion is the one of docs/design.md, Series
/// without its correction: U_{e_i} = W_s e_i, U_alpha = -K0^-1 r_alpha, d_alpha = G_s^T U_alpha.
/// One factorization K0 = K_T(0) serves every position, direction and order. Coefficients are not scaled:
/// U_alpha in m^(1-|alpha|), f_alpha in N m^-|alpha|; or U_alpha and d_alpha in m N^-|alpha|. One object per
/// thread; the factor is shared.
class SeriesSolver {
 public:
  /// @param factor  of K_T(0)  @throw std::invalid_argument unless the orders are valid
  SeriesSolver(const FeModel& model, const Cholesky& factor, const SeriesOrders& orders,
               SeriesKind kind = SeriesKind::kDisplacement);
  /// The same with the usual degree of the answer.
  SeriesSolver(const FeModel& model, const Cholesky& factor, int order,
               SeriesKind kind = SeriesKind::kDisplacement)
      : SeriesSolver(model, factor, SeriesOrders::of(order), kind) {}
  ~SeriesSolver();

  /// @param patches  1 to kLanes contact patches with at least one free node each
  /// @throw std::runtime_error when C_s is not positive definite or a result is not finite
  void solve(std::span<const Patch> patches);

  /// The monomials of the fields, degree p.
  [[nodiscard]] const MonomialBasis& basis() const noexcept;
  /// The monomials of the answer.
  [[nodiscard]] const MonomialBasis& answerBasis() const noexcept;
  /// f_alpha (driven by force: d_alpha) of the position in a lane, alpha = answerBasis()[k].
  [[nodiscard]] Vec3 answer(int lane, int k) const;
  /// U_alpha of the position in a lane at a volume node.
  [[nodiscard]] Vec3 displacement(int lane, int k, int node) const;
  /// U_alpha of all positions at volume nodes. @param[out] fields  [position][k][node][3]
  void copyDisplacements(std::span<const std::int32_t> nodes, std::span<float> fields) const;
  /// Largest |d| (|f|) at which the series of each lane meets the criteria, over 26 directions, m (N). Driven by
  /// displacement the whole answer is judged; driven by force only its part of degree p, which a model keeps: that bounds
  /// the fields too, and both radii are one. At any radius df/dd is positive definite.
  [[nodiscard]] std::vector<SeriesRadii> domainRadii(const DomainCriteria& criteria) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::solver
