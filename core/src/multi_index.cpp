// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/multi_index.h"

#include <stdexcept>
#include <string>

namespace palpate {

namespace {

using Powers = std::array<std::array<double, MonomialBasis::kMaxOrder + 1>, 3>;

Powers powersOf(const Vec3& x, int order) noexcept {
  Powers power{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    power[axis][0] = 1.0;
    for (std::size_t n = 1; n <= static_cast<std::size_t>(order); ++n)
      power[axis][n] = power[axis][n - 1] * x[static_cast<Eigen::Index>(axis)];
  }
  return power;
}

double at(const Powers& power, std::size_t axis, int exponent) noexcept {
  return power[axis][static_cast<std::size_t>(exponent)];
}

}  // namespace

MonomialBasis::MonomialBasis(int order) : order_(order) {
  if (order < 1 || order > kMaxOrder)
    throw std::invalid_argument("order of the series is " + std::to_string(order) + ", expected 1 to " +
                                std::to_string(kMaxOrder));
  for (int degree = 1; degree <= order; ++degree)
    for (int x = degree; x >= 0; --x)
      for (int y = degree - x; y >= 0; --y) indices_.push_back({x, y, degree - x - y});
}

int MonomialBasis::find(const MultiIndex& alpha) const noexcept {
  const int degree = alpha[0] + alpha[1] + alpha[2];
  if (alpha[0] < 0 || alpha[1] < 0 || alpha[2] < 0 || degree < 1 || degree > order_) return -1;
  const int rest = degree - alpha[0];  // the indices before those with this a_x: 1 + 2 + ... + rest
  return begin(degree) + rest * (rest + 1) / 2 + (rest - alpha[1]);
}

void MonomialBasis::evaluate(const Vec3& x, std::span<double> values) const noexcept PALPATE_NONBLOCKING {
  const Powers power = powersOf(x, order_);
  for (std::size_t k = 0; k < indices_.size(); ++k) {
    const MultiIndex& a = indices_[k];
    values[k] = at(power, 0, a[0]) * at(power, 1, a[1]) * at(power, 2, a[2]);
  }
}

void MonomialBasis::gradient(const Vec3& x, std::span<Vec3> gradient) const noexcept PALPATE_NONBLOCKING {
  const Powers power = powersOf(x, order_);
  for (std::size_t k = 0; k < indices_.size(); ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      MultiIndex a = indices_[k];
      const int exponent = a[axis];
      double slope = 0.0;
      if (exponent > 0) {
        --a[axis];
        slope = exponent * at(power, 0, a[0]) * at(power, 1, a[1]) * at(power, 2, a[2]);
      }
      gradient[k][static_cast<Eigen::Index>(axis)] = slope;
    }
  }
}

}  // namespace palpate
