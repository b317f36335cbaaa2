// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "palpate/core/contact_point.h"
#include "palpate/core/model_view.h"
#include "palpate/core/multi_index.h"
#include "palpate/core/types.h"

namespace palpate {

/// The reaction of the organ to an imposed patch displacement, not truncated to the modes (DESIGN 2.2, 2.3).
///   f(s, d) = sum_b lambda_b sum_alpha (d / d_ref)^alpha f_alpha(p_b)
/// Differs from the paper: exact in its order, displacement-driven. Borrows the model's arrays.
class ContactResponse {
 public:
  ContactResponse(const ModelView& view, const ModelAttributes& attributes);

  /// Force of the tool on the organ, W, N, without clamping. @param d  m. Cost O(C). Real-time: yes.
  [[nodiscard]] Vec3 force(const PositionMix& mix, const Vec3& d) const noexcept PALPATE_NONBLOCKING;
  /// df/dd, N/m, of the same; symmetric, since f is the gradient of an energy. Real-time: yes.
  [[nodiscard]] Mat3 stiffness(const PositionMix& mix, const Vec3& d) const noexcept PALPATE_NONBLOCKING;
  /// d_max(s), m: the length of d up to which the series is trusted. Real-time: yes.
  [[nodiscard]] double domainRadius(const PositionMix& mix) const noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] Vec3 coefficient(const PositionMix& mix, int k) const noexcept PALPATE_NONBLOCKING;

  std::span<const double> force_;
  std::span<const double> domain_radius_;
  MonomialBasis basis_;
  double reference_displacement_;
};

}  // namespace palpate
