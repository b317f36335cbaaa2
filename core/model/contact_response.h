// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/multi_index.h"
#include "core/base/types.h"
#include "core/data/model_view.h"
#include "core/data/parameter_functions.h"
#include "core/model/smooth_mixing.h"

namespace palpate {

/// What the contact patch at one s answers to the parameter p of the model, its coefficients mixed once:
///   sum_k phi_k(p) c_k,   c_k = sum_b lambda_b c_k(p_b)
/// That is f(s, d) in N for a "displacement" model, d(s, f) or d(s, t) in m for "force" and "level".
class ContactSeries {
 public:
  /// c(p). Cost O(C). Real-time: yes.
  [[nodiscard]] Vec3 value(const Vec3& p) const noexcept PALPATE_NONBLOCKING;
  /// dc/dp, 3 x 3; of a level the first column only. Cost O(C). Real-time: yes.
  [[nodiscard]] Mat3 gradient(const Vec3& p) const noexcept PALPATE_NONBLOCKING;
  /// value() and gradient() in one pass. Real-time: yes.
  void evaluate(const Vec3& p, Vec3& value, Mat3& gradient) const noexcept PALPATE_NONBLOCKING;
  /// The same, and turn[j] = d(gradient)/dp_j, symmetric in its second index and j; not of a level. Real-time: yes.
  void evaluate(const Vec3& p, Vec3& value, Mat3& gradient,
                std::array<Mat3, 3>& turn) const noexcept PALPATE_NONBLOCKING;
  /// W(d) = int_0^1 f(tau d) . d dtau of a "displacement" model, J: the energy that the patch has stored, whose
  /// gradient f is (docs/design.md, Series). Cost O(C). Real-time: yes.
  [[nodiscard]] double energy(const Vec3& d) const noexcept PALPATE_NONBLOCKING;
  /// |p| up to which the answer is trusted: d_max in m, f_max in N, or t_max.
  [[nodiscard]] double limit() const noexcept { return limit_; }
  /// L of a "level" model, else 0.
  [[nodiscard]] int levelSteps() const noexcept { return functions_->levelSteps(); }

 private:
  friend class ContactResponse;
  explicit ContactSeries(const ParameterFunctions& functions) noexcept : functions_(&functions) {}
  using Jets = std::array<Vec4, MonomialBasis::kMaxCoefficients>;
  void sum(const Jets& jets, Vec3& value, Mat3& gradient) const noexcept PALPATE_NONBLOCKING;

  const ParameterFunctions* functions_;
  std::array<Vec3, MonomialBasis::kMaxCoefficients + 1>
      coefficient_;  // the first size(); room for whole lines
  double limit_{0.0};
};

/// The contact's own answer. Of a "displacement" model it is not truncated to the modes (docs/design.md, Series, Parts), of
/// the load-driven kinds it is what the modes give (docs/design.md, Reproduction). Borrows the model's arrays, or copies them.
/// Differs from the paper: exact in its order, displacement-driven (the first kind).
class ContactResponse {
 public:
  ContactResponse(const ModelView& view, const ModelAttributes& attributes);

  /// The series at s, mixed linearly. Borrows this object. Cost O(C). Real-time: yes.
  [[nodiscard]] ContactSeries at(const PositionMix& mix) const noexcept PALPATE_NONBLOCKING;
  /// The series at s, mixed as the stencil says. @param limit  of |p|. Real-time: yes.
  [[nodiscard]] ContactSeries at(const Stencil& stencil, double limit) const noexcept PALPATE_NONBLOCKING;
  /// dW/dlambda at fixed d of a "displacement" model, J: sum_b d omega_b/dlambda W_b(d); only its part along changes
  /// that keep the sum of the weights has a meaning. Beyond `limit` W continues with degree 2. Cost about 1.4 C for
  /// each position of the stencil. Real-time: yes.
  [[nodiscard]] Vec3 energySlope(const Stencil& stencil, const Vec3& d,
                                 double limit) const noexcept PALPATE_NONBLOCKING;
  /// ContactSeries::limit() alone: the lambda-weighted mean of d_max; of f_max and t_max the harmonic one,
  /// 1 / sum_b lambda_b / limit_b, which a small one governs. Real-time: yes.
  [[nodiscard]] double limit(const PositionMix& mix) const noexcept PALPATE_NONBLOCKING;

 private:
  /// Numbers that come into the processor's cache together.
  struct alignas(64) Line {
    std::array<double, 8> number{};
  };
  [[nodiscard]] static constexpr std::size_t lines(std::size_t numbers) noexcept { return (numbers + 7) / 8; }
  void copyRows();
  [[nodiscard]] const double* rows() const noexcept { return rows_.front().number.data(); }

  ParameterFunctions functions_;
  std::span<const double> coefficient_;  // [M][size][3]
  std::span<const double> limit_;        // [M]
  bool harmonic_;                        // the mean of the limits
  std::size_t force_lines_{0}, energy_lines_{0};
  // [M] of a "displacement" model, filled up with zeros: lines with its coefficient_, then lines with energy_k,
  // W_b(d) = d_ref sum_k energy_k x^alpha_{k+3}, x = d / d_ref, N
  std::vector<Line> rows_;
};

}  // namespace palpate
