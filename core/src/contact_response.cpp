// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/contact_response.h"

namespace palpate {

Vec3 ContactSeries::value(const Vec3& p) const noexcept PALPATE_NONBLOCKING {
  std::array<double, MonomialBasis::kMaxCoefficients> phi;
  functions_->evaluate(p, phi);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(functions_->size()); ++k)
    sum += phi[k] * coefficient_[k];
  return sum;
}

Mat3 ContactSeries::gradient(const Vec3& p) const noexcept PALPATE_NONBLOCKING {
  std::array<Vec3, MonomialBasis::kMaxCoefficients> gradient;
  functions_->gradient(p, gradient);
  Mat3 sum = Mat3::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(functions_->size()); ++k)
    sum += coefficient_[k] * gradient[k].transpose();
  return sum / functions_->reference();
}

ContactResponse::ContactResponse(const ModelView& view, const ModelAttributes& attributes)
    : functions_(view, attributes, attributes.force_order),
      coefficient_(attributes.parameters == Parameters::kDisplacement ? view.contact_force
                                                                      : view.contact_displacement),
      limit_(view.contact_domain_radius),
      harmonic_(attributes.parameters != Parameters::kDisplacement) {}

ContactSeries ContactResponse::at(const PositionMix& mix) const noexcept PALPATE_NONBLOCKING {
  ContactSeries series(functions_);
  const auto C = static_cast<std::size_t>(functions_.size());
  for (std::size_t k = 0; k < C; ++k) {
    Vec3& sum = series.coefficient_[k];
    sum.setZero();
    for (std::size_t b = 0; b < static_cast<std::size_t>(mix.count); ++b) {
      const std::size_t row = static_cast<std::size_t>(mix.position[b]) * C + k;
      sum += mix.weight[b] * Eigen::Map<const Vec3>(coefficient_.data() + 3 * row);
    }
  }
  series.limit_ = limit(mix);
  return series;
}

double ContactResponse::limit(const PositionMix& mix) const noexcept PALPATE_NONBLOCKING {
  double sum = 0.0;
  for (std::size_t b = 0; b < static_cast<std::size_t>(mix.count); ++b) {
    const double limit = limit_[static_cast<std::size_t>(mix.position[b])];
    sum += mix.weight[b] * (harmonic_ ? 1.0 / limit : limit);
  }
  return harmonic_ ? 1.0 / sum : sum;
}

}  // namespace palpate
