// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/base/budget.h"
#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "core/response/response.h"

namespace palpate {

/// The organ's answers at one s, its coefficients mixed once: for loops over d.
class PatchResponse {
 public:
  /// Borrows the model. Cost O(C). Real-time: yes.
  PatchResponse(const MetaModel& model, const ContactPoint& s) noexcept PALPATE_NONBLOCKING;
  /// respond() at this s. Real-time: yes.
  [[nodiscard]] ResponseStatus at(const Vec3& d, Response& out) const noexcept PALPATE_NONBLOCKING;
  /// The same in a tick: spends what it costs. A search that the budget cuts short answers what came nearest, kBeyond.
  [[nodiscard]] ResponseStatus at(const Vec3& d, Budget& budget,
                                  Response& out) const noexcept PALPATE_NONBLOCKING;
  /// dW/dlambda at fixed d, lambda the barycentric weights of s, J: what pushes the anchor, beside the force, where the
  /// organ is not equally stiff everywhere. Zero of a load-driven model, whose energy is not at hand. Real-time: yes.
  [[nodiscard]] Vec3 energySlope(const Vec3& d) const noexcept PALPATE_NONBLOCKING;
  /// W(s, d), J; zero of a load-driven model. Real-time: yes.
  [[nodiscard]] double energy(const Vec3& d) const noexcept PALPATE_NONBLOCKING;

 private:
  const MetaModel& model_;
  Stencil stencil_;
  PatchStiffness::Value stiffness_;
  ContactSeries series_;
};

/// Reaction of the organ to a tool that displaced its contact patch at s by d   docs/design.md, Series, Contact
/// |d| beyond d_max is kBeyond: force or field may be off by more than is promised. |d| beyond r_max is scaled to it,
/// d_c = r_max d / |d|, and the force continues along the symmetrized, positive part of the stiffness there:
/// f = f(s, d_c) + (df/dd)+ (d - d_c). It is continuous, and its stiffness, the derivative, is never negative. The field is
/// extrapolated along d, up to kShownRadii r_max.
/// A "force" model is searched for the f with d(s, f) = d (bounded Newton), a "level" model for the t with
/// e . d(s, t) = e . d, e the load's direction. Where no f gives d, kBeyond: beyond f_max the f_max in its
/// direction; where the model turns back before that, the f at which |d(s, f) - d| is smallest, as found downhill
/// from f = 0, with zero stiffness and domain_radius = |displacement|. Where no t does, kBeyond: 0 or t_max.
/// Numbers that overflow, or a compliance at rest without an inverse: a force of NaN and zeros beside it, kBeyond.
/// @param[in]  s  contact point of this model's surface, @param[in]  d  W, m, finite
/// @param[out] out  always written; zero when not accessible
/// @return kOk, kBeyond, or kNoAnswer (the model has no answer at s). Real-time: yes.
/// Cost O(C). "force": 3 to 5 Newton steps; where no f gives d up to 12 of them, of 7 evaluations, and 30 steps of
/// 2; measured worst of 6000 random polynomials 32, 70 and 140 us at order 3, 5 and 7. "level": at most 18
/// evaluations.
[[nodiscard]] ResponseStatus respond(const MetaModel& model, const ContactPoint& s, const Vec3& d,
                                     Response& out) noexcept PALPATE_NONBLOCKING;

/// Answer of a load-driven model to a given load.                         docs/design.md, Reproduction
/// @param[in]  load  f in W, N, of a "force" model, clamped to f_max(s); (t, 0, 0) of a "level" model, t clamped
///             to [0, t_max(s)]
/// @param[out] out  always written; stiffness is (dd/df)^-1, zero where dd/df is not positive definite; numbers
///             that overflow as in respond(); a t of NaN is 0, kBeyond
/// @return kOk, kBeyond, or kNoAnswer (no answer at s, or a "displacement" model). Cost O(C). Real-time: yes.
[[nodiscard]] ResponseStatus respondToLoad(const MetaModel& model, const ContactPoint& s, const Vec3& load,
                                           Response& out) noexcept PALPATE_NONBLOCKING;

/// evaluateField() of one tool that imposes d: the field of respond()'s parameter. @param d  W, m
void evaluateField(const MetaModel& model, const ContactPoint& s, const Vec3& d, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
