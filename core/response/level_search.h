// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/data/model_view.h"
#include "core/model/contact_response.h"
#include "core/response/response.h"

namespace palpate {

/// d(s, t) and f = t load e, t clamped to [0, t_max], NaN as 0; stiffness load e e^T / (e . dd/dt).
[[nodiscard]] ResponseStatus answerToLevel(const ContactSeries& series, const ModelAttributes& attributes,
                                           double t, Response& out) noexcept PALPATE_NONBLOCKING;

/// The level with e . d(s, t) = e . d, e the load's direction: only one number is free. Bisection over the
/// steps, then exact within one; the loader saw to it that e . d(s, t) rises at each position up to its t_max.
/// e . d <= 0 or NaN gives t = 0. Cost at most 18 evaluations.
[[nodiscard]] ResponseStatus findLevel(const ContactSeries& series, const ModelAttributes& attributes,
                                       const Vec3& d, Response& out) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
