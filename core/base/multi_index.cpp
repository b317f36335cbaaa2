// SPDX-License-Identifier: Apache-2.0
#include "core/base/multi_index.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace palpate {

namespace {

/// Visits the monomials of degree 2 to `order` as products, x^alpha_k = x_axis x^alpha_from, each after its factor:
/// in a degree first x times all of the degree before, then y times those without x, then z^n.
template <typename Visit>
void forEachProduct(int order, Visit&& visit) noexcept {
  std::size_t before = 0, count = 3;  // the degree before: its first, and how many
  for (std::size_t degree = 2; degree <= static_cast<std::size_t>(order); ++degree) {
    const std::size_t first = before + count, without_x = before + count - degree;
    for (std::size_t i = 0; i < count; ++i) visit(first + i, before + i, std::size_t{0});
    for (std::size_t i = 0; i < degree; ++i) visit(first + count + i, without_x + i, std::size_t{1});
    visit(first + count + degree, first - 1, std::size_t{2});
    before = first;
    count += degree + 1;
  }
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
  return positionOf(alpha);
}

int MonomialBasis::positionOf(const MultiIndex& alpha) noexcept {
  const int rest = alpha[1] + alpha[2];  // the indices before those with this a_x: 1 + 2 + ... + rest
  return begin(alpha[0] + rest) + rest * (rest + 1) / 2 + alpha[2];
}

void MonomialBasis::evaluate(const Vec3& x, std::span<double> values) const noexcept PALPATE_NONBLOCKING {
  const std::array<double, 3> factor{x.x(), x.y(), x.z()};
  std::copy(factor.begin(), factor.end(), values.begin());
  forEachProduct(order_, [&](std::size_t k, std::size_t from, std::size_t axis) {
    values[k] = factor[axis] * values[from];
  });
}

void MonomialBasis::gradient(const Vec3& x, std::span<Vec3> gradient) const noexcept PALPATE_NONBLOCKING {
  std::array<Vec4, kMaxCoefficients> all;
  jets(x, all);
  for (std::size_t k = 0; k < indices_.size(); ++k) gradient[k] = all[k].tail<3>();
}

/// By the product rule: d(x_axis m) = x_axis dm + m e_axis.
void MonomialBasis::jets(const Vec3& x, std::span<Vec4> jets) const noexcept PALPATE_NONBLOCKING {
  const std::array<Vec4, 3> slope{Vec4::Unit(1), Vec4::Unit(2), Vec4::Unit(3)};
  const std::array<double, 3> factor{x.x(), x.y(), x.z()};
  for (std::size_t axis = 0; axis < 3; ++axis) jets[axis] = slope[axis] + factor[axis] * Vec4::Unit(0);
  forEachProduct(order_, [&](std::size_t k, std::size_t from, std::size_t axis) {
    jets[k] = factor[axis] * jets[from] + jets[from][0] * slope[axis];
  });
}

/// By the product rule: d^2(x_axis m) = x_axis d^2 m + e_axis dm^T + dm e_axis^T.
void MonomialBasis::bends(const Vec3& x, std::span<const Vec4> jets,
                          std::span<Vec6> bends) const noexcept PALPATE_NONBLOCKING {
  constexpr std::array<std::array<Eigen::Index, 3>, 3> kEntry{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
  const std::array<double, 3> factor{x.x(), x.y(), x.z()};
  for (std::size_t axis = 0; axis < 3; ++axis) bends[axis].setZero();
  forEachProduct(order_, [&](std::size_t k, std::size_t from, std::size_t axis) {
    bends[k] = factor[axis] * bends[from];
    for (std::size_t other = 0; other < 3; ++other)
      bends[k][kEntry[axis][other]] += (other == axis ? 2.0 : 1.0) * jets[from][1 + Eigen::Index(other)];
  });
}

}  // namespace palpate
