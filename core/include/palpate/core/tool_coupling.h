// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "palpate/core/contact_point.h"
#include "palpate/core/meta_model.h"
#include "palpate/core/response.h"
#include "palpate/core/types.h"

namespace palpate {

/// Displacement of the contact patch at `at` by a tool elsewhere: P_at u, far plus near field.    DESIGN 1, 2.3
/// @param source  the other tool's own part, clamped to the domain as in evaluateField()
/// @return m, W; zero where the model has no answer at `at` or at source.s
/// Cost O(C n); with the default organ see core/README.md. Real-time: yes. Threads: one per scratch.
[[nodiscard]] Vec3 patchDisplacement(const MetaModel& model, const FieldSource& source,
                                     const ContactPoint& at,
                                     FieldScratch& scratch) noexcept PALPATE_NONBLOCKING;

/// What a tool that imposes d by itself adds to the field: of evaluateField() and patchDisplacement(). Beyond the
/// domain its gain is |d| over the |d| that the model answers, so that the field goes on in proportion (not of a
/// model driven by level, which ends where its load does). @param d  m, finite. Cost respond(). Real-time: yes.
[[nodiscard]] FieldSource ownPart(const MetaModel& model, const ContactPoint& s,
                                  const Vec3& d) noexcept PALPATE_NONBLOCKING;

/// Tools that press together: what each adds by itself, so that all patches move as prescribed.    DESIGN 3.1
///   d_own,A + sum_{B != A} P_A u(s_B, d_own,B) = d_A,   then f_A = f(s_A, d_own,A), u = sum_A u(s_A, d_own,A)
/// Quasi-Newton from the slopes at rest (Broyden, damped): exact for a linear organ; the error of a nonlinear one
/// is what palpate-query --tool2 measures. Beyond its domain a tool's field goes on in proportion to d_own. Tools
/// nearer to each other than a patch is wide, that ask for different d, get the least-squares answer.
/// @param s  contact points, at most kMaxTools, all in contact  @param d  prescribed, m, finite, one for each
/// @param iterations  >= 0; 4 from d itself, 2 from the last tick: core/README.md
/// @param[in,out] own  in: where to start, d or what the last tick found; out: d_own, m, not clamped
/// @return what is left: the largest |d_A - d_own,A - sum_B P_A u_B|, m; 0 for one tool
/// Cost tools * (tools - 1) * (4 + iterations) patchDisplacement(). Real-time: yes.
double ownDisplacements(const MetaModel& model, std::span<const ContactPoint> s, std::span<const Vec3> d,
                        int iterations, FieldScratch& scratch,
                        std::span<Vec3> own) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
