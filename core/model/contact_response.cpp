// SPDX-License-Identifier: Apache-2.0
#include "core/model/contact_response.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/index.h"
#include "core/base/length.h"

namespace palpate {

namespace {

constexpr std::size_t kLinear = kLinearCoefficients;                           // PatchStiffness's
constexpr auto kQuadratic = static_cast<std::size_t>(MonomialBasis::size(2));  // of the energy, likewise

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
      harmonic_(attributes.parameters != Parameters::kDisplacement),
      energy_basis_(harmonic_ ? 1 : attributes.force_order + 1) {
  if (harmonic_) return;
  fillDerivatives();
  fillRows();
}

void ContactResponse::fillDerivatives() {
  const auto narrow = [](int number) { return static_cast<std::uint8_t>(number); };
  const MonomialBasis& basis = functions_.basis();
  for (int k = static_cast<int>(kLinear); k < basis.size(); ++k) {
    const auto& [x, y, z] = basis[k];
    const int place = MonomialBasis::positionOf({x + 1, y, z}) - static_cast<int>(kQuadratic);
    derivatives_.push_back(
        {narrow(place), narrow(place + y + z + 1), {narrow(x + 1), narrow(y + 1), narrow(z + 1)}});
  }
}

/// W / d_ref = int_0^1 f(tau d) . x dtau: what in a file's forces is no derivative of an energy is left out.
void ContactResponse::fillRows() {
  const MonomialBasis& basis = functions_.basis();
  lines_ = (index(energy_basis_.size()) - kQuadratic + kPerLine - 1) / kPerLine;
  rows_.resize(limit_.size() * lines_);
  if (rows_.empty()) return;
  double* row = rows_.front().number.data();
  const double* f = coefficient_.data();
  for (std::size_t b = 0; b < limit_.size(); ++b, row += rowLength(), f += 3 * basis.size())
    for (int k = static_cast<int>(kLinear); k < basis.size(); ++k)
      for (std::size_t i = 0; i < 3; ++i) {
        MultiIndex beta = basis[k];
        ++beta[i];
        row[index(MonomialBasis::positionOf(beta)) - kQuadratic] +=
            f[3 * index(k) + i] / (beta[0] + beta[1] + beta[2]);
      }
}

/// @param energy  a row, or a mixture of rows @param[out] force  its derivative's coefficients, from degree 2 on
void ContactResponse::derive(const double* energy, Vec3* force) const noexcept PALPATE_NONBLOCKING {
  for (const auto& [x, y, times] : derivatives_)
    *force++ = Vec3(times[0] * energy[x], times[1] * energy[y], times[2] * energy[y + 1]);
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
  std::array<double, MonomialBasis::kMaxCoefficients> energy;
  mixRows(rowsOf(stencil), stencil.weight.data(), rowLength(), energy.data());
  derive(energy.data(), series.coefficient_.data() + kLinear);
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
  std::array<double, MonomialBasis::kMaxCoefficients + kPerLine> monomial;
  energy_basis_.evaluate(at / functions_.reference(), monomial);
  std::fill_n(monomial.begin() + energy_basis_.size(), kPerLine, 0.0);
  std::array<double, Stencil::kMost> W;
  dotRows(rowsOf(stencil), monomial.data() + kQuadratic, rowLength(), W.data());  // over d_ref
  Vec3 slope = Vec3::Zero();
  for (std::size_t b = 0; b < stencil.count; ++b) slope += W[b] * stencil.slope[b];
  slope *= beyond * beyond * functions_.reference();
  for (std::size_t k = 0; k < 3; ++k)
    slope[static_cast<Eigen::Index>(k)] += 0.5 * d.dot(stiffness_slope[k] * d);
  return slope;
}

double ContactResponse::domainRadius(const PositionMix& mix) const noexcept PALPATE_NONBLOCKING {
  if (harmonic_) return meanOf(domain_radius_, mix);
  const auto radius = [&](std::size_t b) {
    return domain_radius_[static_cast<std::size_t>(mix.position[b])];
  };
  const auto count = static_cast<std::size_t>(mix.count);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < count; ++b)
    if (mix.weight[b] > 0.0) least = std::min(least, radius(b));
  if (count == 0 || !(least > 0.0)) return 0.0;
  double error = 0.0;  // at the least radius: about abs(d)^4 is what fields of degree 4 leave out of abs(d)
  for (std::size_t b = 0; b < count; ++b) {
    if (!(mix.weight[b] > 0.0)) continue;
    const double part = least / radius(b);
    error += mix.weight[b] * part * part * part * part;
  }
  return least / std::sqrt(std::sqrt(error));
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
