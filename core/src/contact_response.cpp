// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/contact_response.h"

#include <array>

namespace palpate {

ContactResponse::ContactResponse(const ModelView& view, const ModelAttributes& attributes)
    : force_(view.contact_force),
      domain_radius_(view.contact_domain_radius),
      basis_(attributes.force_order),
      reference_displacement_(attributes.reference_displacement) {}

Vec3 ContactResponse::coefficient(const PositionMix& mix, int k) const noexcept PALPATE_NONBLOCKING {
  const auto C = static_cast<std::size_t>(basis_.size());
  Vec3 sum = Vec3::Zero();
  for (std::size_t b = 0; b < static_cast<std::size_t>(mix.count); ++b) {
    const std::size_t row = static_cast<std::size_t>(mix.position[b]) * C + static_cast<std::size_t>(k);
    sum += mix.weight[b] * Eigen::Map<const Vec3>(force_.data() + 3 * row);
  }
  return sum;
}

Vec3 ContactResponse::force(const PositionMix& mix, const Vec3& d) const noexcept PALPATE_NONBLOCKING {
  std::array<double, MonomialBasis::kMaxCoefficients> monomial;
  basis_.evaluate(d / reference_displacement_, monomial);
  Vec3 f = Vec3::Zero();
  for (int k = 0; k < basis_.size(); ++k) f += monomial[static_cast<std::size_t>(k)] * coefficient(mix, k);
  return f;
}

Mat3 ContactResponse::stiffness(const PositionMix& mix, const Vec3& d) const noexcept PALPATE_NONBLOCKING {
  std::array<Vec3, MonomialBasis::kMaxCoefficients> gradient;
  basis_.gradient(d / reference_displacement_, gradient);
  Mat3 K = Mat3::Zero();
  for (int k = 0; k < basis_.size(); ++k)
    K += coefficient(mix, k) * gradient[static_cast<std::size_t>(k)].transpose();
  return K / reference_displacement_;
}

double ContactResponse::domainRadius(const PositionMix& mix) const noexcept PALPATE_NONBLOCKING {
  double radius = 0.0;
  for (std::size_t b = 0; b < static_cast<std::size_t>(mix.count); ++b)
    radius += mix.weight[b] * domain_radius_[static_cast<std::size_t>(mix.position[b])];
  return radius;
}

}  // namespace palpate
