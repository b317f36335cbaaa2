// SPDX-License-Identifier: Apache-2.0
#include "core/model/contact_response.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/base/kernels.h"
#include "core/base/length.h"

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

/// One row of value and gradient for each component: whole vectors, nothing is stored on the way.
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
      limit_(view.contact_domain_radius),
      harmonic_(attributes.parameters != Parameters::kDisplacement) {
  if (attributes.parameters == Parameters::kDisplacement) copyRows();
}

/// The energy int_0^1 f_b(tau d) . d dtau goes term by term: d_axis (d / d_ref)^alpha has the degree |alpha| + 1, and
/// some terms meet.
void ContactResponse::copyRows() {
  const MonomialBasis& basis = functions_.basis();
  const std::size_t width = 3 * static_cast<std::size_t>(basis.size());
  std::vector<std::pair<std::size_t, double>> goes(width);  // where to, and divided by what
  for (std::size_t entry = 0; entry < width; ++entry) {
    MultiIndex alpha = basis[static_cast<int>(entry / 3)];
    ++alpha[entry % 3];
    goes[entry] = {static_cast<std::size_t>(MonomialBasis::positionOf(alpha) - 3),
                   double(alpha[0] + alpha[1] + alpha[2])};
  }
  force_lines_ = lines(width);
  energy_lines_ = lines(static_cast<std::size_t>(MonomialBasis::size(basis.order() + 1) - 3));
  rows_.resize(limit_.size() * (force_lines_ + energy_lines_));
  for (std::size_t b = 0; b < limit_.size(); ++b) {
    double* const row = rows_[b * (force_lines_ + energy_lines_)].number.data();
    const std::span<const double> c = coefficient_.subspan(b * width, width);
    std::copy(c.begin(), c.end(), row);
    for (std::size_t entry = 0; entry < width; ++entry)
      row[8 * force_lines_ + goes[entry].first] += c[entry] / goes[entry].second;
  }
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
  return series;
}

ContactSeries ContactResponse::at(const Stencil& stencil, double limit) const noexcept PALPATE_NONBLOCKING {
  ContactSeries series(functions_);
  mixRows({rows(), 8 * (force_lines_ + energy_lines_), stencil.position.data(), stencil.count},
          stencil.weight.data(), 8 * force_lines_, series.coefficient_.front().data());
  series.limit_ = limit;
  return series;
}

Vec3 ContactResponse::energySlope(const Stencil& stencil, const Vec3& d,
                                  double limit) const noexcept PALPATE_NONBLOCKING {
  const double length = lengthOf(d), beyond = length > limit ? length / limit : 1.0;
  const Vec3 x = d / (beyond * functions_.reference());
  std::array<double, MonomialBasis::kMaxCoefficients> phi;
  constexpr std::size_t kMost = MonomialBasis::size(MonomialBasis::kMaxOrder + 1);
  std::array<double, 8 * lines(kMost)> products;
  std::fill_n(products.begin() + std::ptrdiff_t(8 * energy_lines_) - 8, 8, 0.0);
  functions_.basis().evaluate(x, phi);
  functions_.basis().products(x, phi, products);
  std::array<double, Stencil::kMost> W;  // over d_ref
  dotRows(
      {rows() + 8 * force_lines_, 8 * (force_lines_ + energy_lines_), stencil.position.data(), stencil.count},
      products.data(), 8 * energy_lines_, W.data());
  Vec3 slope = Vec3::Zero();
  for (std::size_t b = 0; b < stencil.count; ++b) slope += W[b] * stencil.slope[b];
  return functions_.reference() * beyond * beyond * slope;
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
