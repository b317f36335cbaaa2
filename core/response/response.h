// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "core/base/types.h"

namespace palpate {

enum class ResponseStatus { kOk, kBeyond, kNoAnswer };

/// "ok", "beyond_domain", "not_accessible".
[[nodiscard]] std::string_view toString(ResponseStatus status) noexcept;

/// What the organ answers to a patch displacement, before release, friction and limits.
struct Response {
  Vec3 force = Vec3::Zero();         ///< f, of the tool on the organ, W, N
  Mat3 stiffness = Mat3::Zero();     ///< df/dd, N/m; beyond r_max that of the continued force
  Vec3 displacement = Vec3::Zero();  ///< the d that the fields show: no longer than shown_radius, m
  double domain_radius{0.0};         ///< d_max(s), m; of a load-driven model that along the load's direction
  double series_radius{
      0.0};                  ///< r_max(s) >= d_max(s), m: the polynomials run up to it; load-driven: d_max(s)
  double shown_radius{0.0};  ///< how far fields go, m: kShownRadii r_max(s); load-driven: d_max(s)
  Vec3 parameter = Vec3::Zero();  ///< what evaluateField() takes: displacement, m; f, N; or (t, 0, 0)
};

}  // namespace palpate
