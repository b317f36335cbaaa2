// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/budget.h"
#include "core/model/contact_response.h"
#include "core/response/response.h"

namespace palpate {

// The answers of models whose parameter is the load: to a load that is given, and to a displacement, for which
// the load is found. All of them write `out` and return kOk or kBeyond. Numbers that overflow, or a model whose
// compliance at rest has no inverse, give a force of NaN and zeros beside it, kBeyond: the tick holds and fades
// what was before (kNonFiniteForce). Real-time: yes.

/// `status`, or what a model answers whose numbers overflow.
[[nodiscard]] ResponseStatus checked(ResponseStatus status, Response& out) noexcept PALPATE_NONBLOCKING;

/// d(s, f), f clamped to f_max; stiffness (dd/df)^-1, or zero where the symmetric part of dd/df is not positive
/// definite: there the model has folded, and its force would push a tool on.
[[nodiscard]] ResponseStatus answerToForce(const ContactSeries& series, const Vec3& f,
                                           Response& out) noexcept PALPATE_NONBLOCKING;

/// The f with d(s, f) = d, by damped Newton. Beyond f_max d is continued with degree 1, d(f_c) |f| / f_max with
/// f_c = f_max f / |f|: a d whose f lies there is answered by f_c and its d(f_c), which is d scaled.
/// Where Newton fails, or ends where dd/df is not positive definite, at most 30 Levenberg-Marquardt steps from
/// f = 0 lower |d(s, f) - d|^2; what they end at is answered, kBeyond and without stiffness if it misses d or is
/// not positive definite either.
/// Cost: 3 to 5 Newton steps where it works; at most 12, of up to 7 evaluations each, and 30 more of two each. Where
/// the budget ends before, what the search has come to by then is answered as what misses d.
[[nodiscard]] ResponseStatus findForce(const ContactSeries& series, const Vec3& d, Budget& budget,
                                       Response& out) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
