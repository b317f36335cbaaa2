// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/core/contact_response.h"
#include "palpate/core/model_view.h"
#include "palpate/core/response.h"

namespace palpate {

// The answers of models whose parameter is the load: to a load that is given, and to a displacement, for which
// the load is found. All of them write `out`, with finite numbers, and return kOk or kClamped. Real-time: yes.

/// d, or d scaled to the length `radius`.
[[nodiscard]] Vec3 clampToDomain(const Vec3& d, double radius) noexcept PALPATE_NONBLOCKING;

/// Derivative of d -> radius d / |d|, for |d| > 0.
[[nodiscard]] Mat3 projectionGradient(const Vec3& d, double radius) noexcept PALPATE_NONBLOCKING;

/// d(s, f), f clamped to f_max; stiffness (dd/df)^-1.
[[nodiscard]] ResponseStatus answerToForce(const ContactSeries& series, const Vec3& f,
                                           Response& out) noexcept PALPATE_NONBLOCKING;

/// The f with d(s, f) = d, by damped Newton. Beyond f_max d is continued with degree 1, d(f_c) |f| / f_max with
/// f_c = f_max f / |f|: a d whose f lies there is answered by f_c and its d(f_c), which is d scaled.
/// Where Newton fails, the largest share of d that it reaches (of 32nds) is answered, kClamped.
/// Cost at most 6 x 12 Newton steps; one needs 3 to 5.
[[nodiscard]] ResponseStatus findForce(const ContactSeries& series, const Vec3& d,
                                       Response& out) noexcept PALPATE_NONBLOCKING;

/// d(s, t) and f = t load e, t clamped to [0, t_max]; stiffness load e e^T / (e . dd/dt).
[[nodiscard]] ResponseStatus answerToLevel(const ContactSeries& series, const ModelAttributes& attributes,
                                           double t, Response& out) noexcept PALPATE_NONBLOCKING;

/// The level with e . d(s, t) = e . d, e the load's direction: only one number is free. Bisection over the
/// steps, then exact within one. e . d <= 0 gives t = 0. Cost at most 18 evaluations.
[[nodiscard]] ResponseStatus findLevel(const ContactSeries& series, const ModelAttributes& attributes,
                                       const Vec3& d, Response& out) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
