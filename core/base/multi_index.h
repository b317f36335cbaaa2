// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/types.h"

namespace palpate {

/// Exponents (a_x, a_y, a_z) of one monomial d^alpha = d_x^a_x d_y^a_y d_z^a_z.
using MultiIndex = std::array<int, 3>;

/// The monomials d^alpha with 1 <= |alpha| <= p, in the order in which every file and table holds them
///                                                                            docs/design.md, Symbols, Series
///   by degree, then lexicographically descending: x y z | xx xy xz yy yz zz | xxx xxy ...
/// There is no constant term: an organ that is not touched does not move.
class MonomialBasis {
 public:
  static constexpr int kMaxOrder = 9;           ///< 219 monomials: an energy, whose force has degree 8
  static constexpr int kMaxCoefficients = 219;  ///< size(kMaxOrder)

  /// Number of monomials up to degree p: (p+1)(p+2)(p+3)/6 - 1, e.g. 3, 9, 19, 34, 55.
  [[nodiscard]] static constexpr int size(int order) noexcept {
    return (order + 1) * (order + 2) * (order + 3) / 6 - 1;
  }

  /// @throw std::invalid_argument unless 1 <= order <= kMaxOrder
  explicit MonomialBasis(int order);

  [[nodiscard]] int order() const noexcept { return order_; }
  [[nodiscard]] int size() const noexcept { return static_cast<int>(indices_.size()); }
  [[nodiscard]] const MultiIndex& operator[](int k) const noexcept {
    return indices_[static_cast<std::size_t>(k)];
  }
  /// Position of alpha in the list, -1 when its degree is 0 or above the order.
  [[nodiscard]] int find(const MultiIndex& alpha) const noexcept;
  /// Position of alpha in the list of any order that has its degree, 1 or more.
  [[nodiscard]] static int positionOf(const MultiIndex& alpha) noexcept;
  /// First position of degree n (1 <= n <= order); begin(order + 1) is size().
  [[nodiscard]] static constexpr int begin(int degree) noexcept { return size(degree - 1); }

  /// values[k] = x^alpha_k. @param[out] values  size() numbers. Real-time: yes.
  void evaluate(const Vec3& x, std::span<double> values) const noexcept PALPATE_NONBLOCKING;
  /// gradient[k] = d(x^alpha_k)/dx. @param[out] gradient  size() vectors. Real-time: yes.
  void gradient(const Vec3& x, std::span<Vec3> gradient) const noexcept PALPATE_NONBLOCKING;
  /// jets[k] = x^alpha_k, d/dx, d/dy, d/dz of it. @param[out] jets  size() of them. Real-time: yes.
  void jets(const Vec3& x, std::span<Vec4> jets) const noexcept PALPATE_NONBLOCKING;
  /// bends[k] = second derivatives of x^alpha_k: xx xy xz yy yz zz. @param  jets  jets() at x
  /// @param[out] bends  size() of them. Real-time: yes.
  void bends(const Vec3& x, std::span<const Vec4> jets,
             std::span<Vec6> bends) const noexcept PALPATE_NONBLOCKING;

 private:
  int order_;
  std::vector<MultiIndex> indices_;
};

/// Highest degrees of a model: of the fields, and of the force, which costs a tick.
inline constexpr int kMostOrder = 7, kMostForceOrder = 8;

}  // namespace palpate
