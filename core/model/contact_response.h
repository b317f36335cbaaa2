// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/index.h"
#include "core/base/kernels.h"
#include "core/base/multi_index.h"
#include "core/base/prefetch.h"
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
  /// |p| up to which the polynomials run: r_max in m, f_max in N, or t_max.
  [[nodiscard]] double limit() const noexcept { return limit_; }
  /// |p| up to which the answer is trusted: d_max in m, which is at most r_max, f_max in N, or t_max.
  [[nodiscard]] double domainRadius() const noexcept { return domain_radius_; }
  /// L of a "level" model, else 0.
  [[nodiscard]] int levelSteps() const noexcept { return functions_->levelSteps(); }

 private:
  friend class ContactResponse;
  explicit ContactSeries(const ParameterFunctions& functions) noexcept : functions_(&functions) {}
  using Jets = std::array<Vec4, MonomialBasis::kMaxCoefficients>;
  void sum(const Jets& jets, Vec3& value, Mat3& gradient) const noexcept PALPATE_NONBLOCKING;

  const ParameterFunctions* functions_;
  std::array<Vec3, MonomialBasis::size(kMostForceOrder)> coefficient_;  // the first size()
  double limit_{0.0}, domain_radius_{0.0};
};

/// The contact's own answer. Of a "displacement" model it is not truncated to the modes (docs/design.md, Series, Parts), of
/// the load-driven kinds it is what the modes give (docs/design.md, Reproduction). Borrows the model's arrays, or copies them.
/// Differs from the paper: exact in its order, displacement-driven (the first kind).
class ContactResponse {
 public:
  ContactResponse(const ModelView& view, const ModelAttributes& attributes);

  /// The series at s, mixed linearly. Borrows this object. Cost O(C). Real-time: yes.
  [[nodiscard]] ContactSeries at(const PositionMix& mix) const noexcept PALPATE_NONBLOCKING;
  /// The series at s of a "displacement" model: degree 1 from the patch's own stiffness, the others mixed as the stencil says.
  /// @param mix  for the radii. Real-time: yes.
  [[nodiscard]] ContactSeries at(const Stencil& stencil, const Mat3& stiffness,
                                 const PositionMix& mix) const noexcept PALPATE_NONBLOCKING;
  /// dW/dlambda at fixed d of a "displacement" model, J: d . dK/dlambda d / 2 + sum_b d omega_b/dlambda W_b(d), W_b of degree
  /// 3 and more; only its part along changes that keep the sum of the weights has a meaning. Beyond `limit` W continues with
  /// degree 2. Cost about 1.4 C for each position of the stencil. Real-time: yes.
  [[nodiscard]] Vec3 energySlope(const Stencil& stencil, const std::array<Mat3, 3>& stiffness_slope,
                                 const Vec3& d, double limit) const noexcept PALPATE_NONBLOCKING;
  /// ContactSeries::limit() alone: the lambda-weighted mean of r_max; of f_max and t_max the harmonic one,
  /// 1 / sum_b lambda_b / limit_b, which a small one governs. Real-time: yes.
  [[nodiscard]] double limit(const PositionMix& mix) const noexcept PALPATE_NONBLOCKING {
    return meanOf(limit_, mix);
  }
  /// ContactSeries::domainRadius() alone: of f_max and t_max the same mean as of the limit; d_max(s) is where the mixed error of
  /// the positions reaches what each has at its own d_max, (sum_b lambda_b d_max,b^-4)^(-1/4) (docs/decisions/domain.md). Real-time: yes.
  [[nodiscard]] double domainRadius(const PositionMix& mix) const noexcept PALPATE_NONBLOCKING;
  /// Asks the cache for what the mix with a position reads. Real-time: yes.
  void expect(std::int32_t position) const noexcept PALPATE_NONBLOCKING {
    prefetch(rows_.data() + index(position) * lines_, lines_ * sizeof(Line));
  }

 private:
  /// Numbers that come into the processor's cache together.
  static constexpr std::size_t kPerLine = 8;
  struct alignas(64) Line {
    std::array<double, kPerLine> number{};
  };
  /// The coefficient of x^alpha in f_i is (alpha_i + 1) / d_ref times that of x^(alpha + e_i) in the energy. In a row
  /// alpha + e_y comes alpha_y + alpha_z + 1 behind alpha + e_x, and alpha + e_z right behind that.
  struct Derivative {
    std::uint8_t x, y;  // places in a row
    std::array<std::uint8_t, 3> times;
  };
  void fillDerivatives();
  void fillRows();
  void derive(const double* energy, Vec3* force) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] double meanOf(std::span<const double> radius,
                              const PositionMix& mix) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Rows rowsOf(const Stencil& stencil) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] std::size_t rowLength() const noexcept PALPATE_NONBLOCKING { return kPerLine * lines_; }

  ParameterFunctions functions_;
  std::span<const double> coefficient_;    // [M][size][3]
  std::span<const double> limit_;          // [M]
  std::span<const double> domain_radius_;  // [M]
  bool harmonic_;                          // the mean of the limits
  std::size_t lines_{0};                   // of a row
  // Of a "displacement" model. [M]: coefficients of the energy over d_ref from degree 3 on, N, filled up with zeros. They are
  // less than half the numbers of the force, and a tick whose cache is cold waits for memory, not for products
  std::vector<Line> rows_;
  std::vector<Derivative> derivatives_;  // of the force's coefficients from degree 2 on
  MonomialBasis energy_basis_;
};

}  // namespace palpate
