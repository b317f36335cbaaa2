// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/contact_response.h"

#include <algorithm>

#include "kernels.h"
#include "palpate/core/length.h"

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

double ContactSeries::energy(const Vec3& d) const noexcept PALPATE_NONBLOCKING {
  std::array<double, MonomialBasis::kMaxCoefficients> share;
  functions_->energyShares(d, share);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(functions_->size()); ++k)
    sum += share[k] * coefficient_[k];
  return sum.dot(d);
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

ContactSeries ContactResponse::at(const Stencil& stencil, double limit) const noexcept PALPATE_NONBLOCKING {
  ContactSeries series(functions_);
  const auto C = static_cast<std::size_t>(functions_.size());
  double* const sum = series.coefficient_.front().data();
  std::fill(sum, sum + 3 * C, 0.0);
  for (std::size_t b = 0; b < stencil.count; ++b) {
    const double* const c = coefficient_.data() + 3 * C * static_cast<std::size_t>(stencil.position[b]);
    addWeighted(stencil.weight[b], c, 3 * C, sum);
  }
  series.limit_ = limit;
  return series;
}

Vec3 ContactResponse::energySlope(const Stencil& stencil, const Vec3& d,
                                  double limit) const noexcept PALPATE_NONBLOCKING {
  const auto C = static_cast<std::size_t>(functions_.size());
  const double length = lengthOf(d), beyond = length > limit ? length / limit : 1.0;
  std::array<double, MonomialBasis::kMaxCoefficients> share;
  functions_.energyShares(d / beyond, share);
  std::array<double, std::size_t{3} * MonomialBasis::kMaxCoefficients> weight;  // W_b = weight . c_b
  for (std::size_t k = 0; k < C; ++k) Eigen::Map<Vec3>(weight.data() + 3 * k) = (share[k] / beyond) * d;
  Vec3 slope = Vec3::Zero();
  for (std::size_t b = 0; b < stencil.count; ++b) {
    const double* const c = coefficient_.data() + 3 * C * static_cast<std::size_t>(stencil.position[b]);
    slope += dot(c, weight.data(), 3 * C) * stencil.slope[b];
  }
  return beyond * beyond * slope;
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
