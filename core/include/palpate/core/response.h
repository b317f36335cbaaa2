// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "palpate/core/budget.h"
#include "palpate/core/contact_point.h"
#include "palpate/core/meta_model.h"
#include "palpate/core/types.h"

namespace palpate {

enum class ResponseStatus { kOk, kClamped, kNoAnswer };

/// "ok", "clamped", "not_accessible".
[[nodiscard]] std::string_view toString(ResponseStatus status) noexcept;

/// What the organ answers to a patch displacement, before release, friction and limits.
struct Response {
  Vec3 force = Vec3::Zero();         ///< f, of the tool on the organ, W, N
  Mat3 stiffness = Mat3::Zero();     ///< df/dd, N/m; beyond the domain that of the continued force
  Vec3 displacement = Vec3::Zero();  ///< the d that the fields show: clamped to the domain, m
  double domain_radius{0.0};         ///< d_max(s), m; of a load-driven model that along the load's direction
  Vec3 parameter = Vec3::Zero();     ///< what evaluateField() takes: the clamped d, m; f, N; or (t, 0, 0)
};

/// The organ's answers at one s, its coefficients mixed once: for loops over d.
class PatchResponse {
 public:
  /// Borrows the model. Cost O(C). Real-time: yes.
  PatchResponse(const MetaModel& model, const ContactPoint& s) noexcept PALPATE_NONBLOCKING;
  /// respond() at this s. Real-time: yes.
  [[nodiscard]] ResponseStatus at(const Vec3& d, Response& out) const noexcept PALPATE_NONBLOCKING;
  /// The same in a tick: spends what it costs. A search that the budget cuts short answers what came nearest, kClamped.
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
  ContactSeries series_;
};

/// Reaction of the organ to a tool that displaced its contact patch at s by d   docs/design.md, Series, Contact
/// |d| beyond the domain is scaled to it, d_c = d_max d / |d|, and the force continues along the symmetrized,
/// positive part of the stiffness there: f = f(s, d_c) + (df/dd)+ (d - d_c). It is continuous, and its stiffness, the
/// derivative, is never negative.
/// A "force" model is searched for the f with d(s, f) = d (bounded Newton), a "level" model for the t with
/// e . d(s, t) = e . d, e the load's direction. Where no f gives d, kClamped: beyond f_max the f_max in its
/// direction; where the model turns back before that, the f at which |d(s, f) - d| is smallest, as found downhill
/// from f = 0, with zero stiffness and domain_radius = |displacement|. Where no t does, kClamped: 0 or t_max.
/// Numbers that overflow, or a compliance at rest without an inverse: a force of NaN and zeros beside it, kClamped.
/// @param[in]  s  contact point of this model's surface, @param[in]  d  W, m, finite
/// @param[out] out  always written; zero when not accessible
/// @return kOk, kClamped, or kNoAnswer (the model has no answer at s). Real-time: yes.
/// Cost O(C). "force": 3 to 5 Newton steps; where no f gives d up to 12 of them, of 7 evaluations, and 30 steps of
/// 2; measured worst of 6000 random polynomials 32, 70 and 140 us at order 3, 5 and 7. "level": at most 18
/// evaluations.
[[nodiscard]] ResponseStatus respond(const MetaModel& model, const ContactPoint& s, const Vec3& d,
                                     Response& out) noexcept PALPATE_NONBLOCKING;

/// Answer of a load-driven model to a given load.                         docs/design.md, Reproduction
/// @param[in]  load  f in W, N, of a "force" model, clamped to f_max(s); (t, 0, 0) of a "level" model, t clamped
///             to [0, t_max(s)]
/// @param[out] out  always written; stiffness is (dd/df)^-1, zero where dd/df is not positive definite; numbers
///             that overflow as in respond(); a t of NaN is 0, kClamped
/// @return kOk, kClamped, or kNoAnswer (no answer at s, or a "displacement" model). Cost O(C). Real-time: yes.
[[nodiscard]] ResponseStatus respondToLoad(const MetaModel& model, const ContactPoint& s, const Vec3& load,
                                           Response& out) noexcept PALPATE_NONBLOCKING;

/// Scratch of the field evaluation; one per thread, allocated before the loop.
struct FieldScratch {
  explicit FieldScratch(const MetaModel& model);
  std::vector<float> amplitudes;  ///< [n] y, m
  std::vector<float> near_block;  ///< NearField::scratchSize()
  ModeSelection selection;        ///< of SeparatedField::expand()
};

/// Modes left out of a field may together move a node by this share of the largest displacement imposed.
inline constexpr double kUnseenShare = 2e-4;

/// One tool's part in a field.
struct FieldSource {
  ContactPoint s;
  Vec3 parameter = Vec3::Zero();  ///< Response::parameter; clamped to the domain
  double gain{1.0};               ///< any finite number

  [[nodiscard]] bool operator==(const FieldSource& other) const noexcept {
    return s == other.s && parameter == other.parameter && gain == other.gain;
  }
};

/// Displacement of the surface nodes, far plus near field, superposed over the tools (docs/design.md, Parts). Of a "displacement"
/// model, packed modes that together are below kUnseenShare of the largest displacement imposed are left out.
/// @param[out] u  [Ns][3], m, overwritten; zero when no source is accessible. Real-time: yes.
void evaluateField(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING;

/// The same for one tool that imposes d: the field of respond()'s parameter. @param d  W, m
void evaluateField(const MetaModel& model, const ContactPoint& s, const Vec3& d, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
