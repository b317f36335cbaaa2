// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "core/base/multi_index.h"
#include "core/base/types.h"
#include "core/data/model_view.h"

namespace palpate {

/// The functions phi_k of the parameter p that the coefficients of a model belong to:
///   "displacement": phi_alpha(d) = (d / d_ref)^alpha                                  docs/design.md, Series
///   "force":        phi_alpha(f) = (f / f_ref)^alpha
///   "level":        phi_q(t) = Z_q(t), piecewise linear, zero at t = 0          docs/design.md, Reproduction
/// p is a vector in every case; a level is (t, 0, 0). Borrows the model's arrays.
class ParameterFunctions {
 public:
  /// @param order  degree of the monomials: of the fields, or of the contact's answer; unused for "level"
  ParameterFunctions(const ModelView& view, const ModelAttributes& attributes, int order);

  [[nodiscard]] int size() const noexcept { return size_; }
  /// L, the number of steps of the level; 0 for monomials.
  [[nodiscard]] int levelSteps() const noexcept { return level_steps_; }
  /// values[k] = phi_k(p). @param[out] values  size() numbers. Real-time: yes.
  void evaluate(const Vec3& p, std::span<double> values) const noexcept PALPATE_NONBLOCKING;
  /// shares[k] = int_0^1 phi_k(tau p) dtau = phi_k(p) / (|alpha| + 1); monomials only. @param[out] shares  size()
  /// numbers. Real-time: yes.
  void energyShares(const Vec3& p, std::span<double> shares) const noexcept PALPATE_NONBLOCKING;
  /// The monomials, of a model that has no levels.
  [[nodiscard]] const MonomialBasis& basis() const noexcept { return basis_; }
  /// d_ref in m, f_ref in N, or 1 of a level.
  [[nodiscard]] double reference() const noexcept { return reference_; }
  /// gradient[k] = reference() dphi_k/dp: the caller divides once, the sum. Of a level that of the segment which
  /// begins at or before t. @param[out] gradient  size() vectors. Real-time: yes.
  void gradient(const Vec3& p, std::span<Vec3> gradient) const noexcept PALPATE_NONBLOCKING;
  /// jets[k] = phi_k(p) and, below it, gradient(). @param[out] jets  size() of them. Real-time: yes.
  void jets(const Vec3& p, std::span<Vec4> jets) const noexcept PALPATE_NONBLOCKING;
  /// bends[k] = reference()^2 times the second derivatives of phi_k; monomials only. @param  jets  jets() at p
  /// @param[out] bends  xx xy xz yy yz zz, size() of them. Real-time: yes.
  void bends(const Vec3& p, std::span<const Vec4> jets,
             std::span<Vec6> bends) const noexcept PALPATE_NONBLOCKING;

 private:
  /// Where t lies among the steps: Z(t) = (1 - weight) Z[step] + weight Z[step + 1].
  struct Place {
    std::size_t step;
    double weight;
  };
  [[nodiscard]] Place place(double t) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] const double* row(int q) const noexcept PALPATE_NONBLOCKING;

  MonomialBasis basis_;
  double reference_;
  std::span<const double> Z_;
  int level_steps_{0};
  int size_;
};

/// The step that a level range [0, limit] of `steps` steps per unit ends in; at least 1.
[[nodiscard]] int lastStep(double limit, int steps) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
