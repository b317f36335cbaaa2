// SPDX-License-Identifier: Apache-2.0
#include "core/model/contact_response.h"

#include <algorithm>
#include <cstddef>

#include "core/base/index.h"
#include "core/base/length.h"

namespace palpate {

namespace {

constexpr std::size_t kLinear = kLinearCoefficients;  // PatchStiffness's
constexpr std::size_t kLinearNumbers = 3 * kLinear;

}  // namespace

Vec3 ContactSeries::value(const Vec3& p) const noexcept PALPATE_NONBLOCKING {
  std::array<double, MonomialBasis::kMaxCoefficients> phi;
  functions_->evaluate(p, phi);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(functions_->size()); ++k)
    sum += phi[k] * coefficient_[k];
  return sum;
}

Mat3 ContactSeries::gradient(const Vec3& p) const noexcept PALPATE_NONBLOCKING {
  Vec3 value;
  Mat3 gradient;
  evaluate(p, value, gradient);
  return gradient;
}

void ContactSeries::evaluate(const Vec3& p, Vec3& value, Mat3& gradient) const noexcept PALPATE_NONBLOCKING {
  Jets jets;
  functions_->jets(p, jets);
  sum(jets, value, gradient);
}

void ContactSeries::sum(const Jets& jets, Vec3& value, Mat3& gradient) const noexcept PALPATE_NONBLOCKING {
  Vec4 x = Vec4::Zero(), y = Vec4::Zero(), z = Vec4::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(functions_->size()); ++k) {
    x += coefficient_[k].x() * jets[k];
    y += coefficient_[k].y() * jets[k];
    z += coefficient_[k].z() * jets[k];
  }
  value = Vec3(x[0], y[0], z[0]);
  gradient << x.tail<3>().transpose(), y.tail<3>().transpose(), z.tail<3>().transpose();
  gradient /= functions_->reference();
}

void ContactSeries::evaluate(const Vec3& p, Vec3& value, Mat3& gradient,
                             std::array<Mat3, 3>& turn) const noexcept PALPATE_NONBLOCKING {
  Jets jets;
  std::array<Vec6, MonomialBasis::kMaxCoefficients> bends;
  functions_->jets(p, jets);
  functions_->bends(p, jets, bends);
  sum(jets, value, gradient);
  Vec6 x = Vec6::Zero(), y = Vec6::Zero(), z = Vec6::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(functions_->size()); ++k) {
    x += coefficient_[k].x() * bends[k];
    y += coefficient_[k].y() * bends[k];
    z += coefficient_[k].z() * bends[k];
  }
  constexpr Eigen::Index kEntry[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  const double square = functions_->reference() * functions_->reference();
  for (std::size_t j = 0; j < 3; ++j)
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::Index entry = kEntry[j][i];
      turn[j].col(i) = Vec3(x[entry], y[entry], z[entry]) / square;
    }
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
      limit_(attributes.parameters == Parameters::kDisplacement ? view.contact_series_radius
                                                                : view.contact_domain_radius),
      domain_radius_(view.contact_domain_radius),
      harmonic_(attributes.parameters != Parameters::kDisplacement) {
  if (attributes.parameters == Parameters::kDisplacement) copyRows();
}

void ContactResponse::copyRows() {
  const std::size_t width = 3 * index(functions_.size()), numbers = width - kLinearNumbers;
  lines_ = (numbers + kPerLine - 1) / kPerLine;
  rows_.resize(limit_.size() * lines_);
  for (std::size_t b = 0; b < limit_.size(); ++b) {
    const std::span<const double> c = coefficient_.subspan(b * width + kLinearNumbers, numbers);
    if (!c.empty()) std::copy(c.begin(), c.end(), rows_[b * lines_].number.begin());
  }
}

Rows ContactResponse::rowsOf(const Stencil& stencil) const noexcept PALPATE_NONBLOCKING {
  return {rows_.empty() ? nullptr : rows_.front().number.data(), rowLength(), stencil.position.data(),
          stencil.count};
}

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
  series.domain_radius_ = domainRadius(mix);
  return series;
}

ContactSeries ContactResponse::at(const Stencil& stencil, const Mat3& stiffness,
                                  const PositionMix& mix) const noexcept PALPATE_NONBLOCKING {
  ContactSeries series(functions_);
  mixRows(rowsOf(stencil), stencil.weight.data(), rowLength(), series.coefficient_[kLinear].data());
  for (std::size_t k = 0; k < 3; ++k)
    series.coefficient_[k] = functions_.reference() * stiffness.col(static_cast<Eigen::Index>(k));
  series.limit_ = limit(mix);
  series.domain_radius_ = domainRadius(mix);
  return series;
}

Vec3 ContactResponse::energySlope(const Stencil& stencil, const std::array<Mat3, 3>& stiffness_slope,
                                  const Vec3& d, double limit) const noexcept PALPATE_NONBLOCKING {
  const double length = lengthOf(d), beyond = length > limit ? length / limit : 1.0;
  const Vec3 at = d / beyond;
  std::array<double, MonomialBasis::kMaxCoefficients> share;
  functions_.energyShares(at, share);
  std::array<Vec3, MonomialBasis::kMaxCoefficients + 2> product;  // as ContactSeries::coefficient_
  const auto size = index(functions_.size());
  for (std::size_t k = kLinear; k < size; ++k) product[k] = share[k] * at;
  for (std::size_t k = size; k < product.size(); ++k) product[k].setZero();
  std::array<double, Stencil::kMost> W;
  dotRows(rowsOf(stencil), product[kLinear].data(), rowLength(), W.data());
  Vec3 slope = Vec3::Zero();
  for (std::size_t b = 0; b < stencil.count; ++b) slope += W[b] * stencil.slope[b];
  slope *= beyond * beyond;
  for (std::size_t k = 0; k < 3; ++k)
    slope[static_cast<Eigen::Index>(k)] += 0.5 * d.dot(stiffness_slope[k] * d);
  return slope;
}

double ContactResponse::meanOf(std::span<const double> radius,
                               const PositionMix& mix) const noexcept PALPATE_NONBLOCKING {
  double sum = 0.0;
  for (std::size_t b = 0; b < static_cast<std::size_t>(mix.count); ++b) {
    const double one = radius[static_cast<std::size_t>(mix.position[b])];
    sum += mix.weight[b] * (harmonic_ ? 1.0 / one : one);
  }
  return harmonic_ ? 1.0 / sum : sum;
}

}  // namespace palpate
