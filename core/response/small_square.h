// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/base/max_tools.h"
#include "core/base/types.h"

namespace palpate {

/// A square matrix of three rows and columns for each of up to kMaxTools tools, row by row, in place. Eigen's matrices
/// of a size known at run time would do, but for products and factors of theirs the compiler cannot see that they
/// allocate nothing, and the first solution of a program initializes a static variable. Real-time: yes.
class SmallSquare {
 public:
  static constexpr std::size_t kMost = 3 * kMaxTools;

  /// The unit matrix. @param tools  1 to kMaxTools
  explicit SmallSquare(std::size_t tools) noexcept PALPATE_NONBLOCKING;

  [[nodiscard]] std::size_t size() const noexcept PALPATE_NONBLOCKING { return size_; }
  [[nodiscard]] double* row(std::size_t i) noexcept PALPATE_NONBLOCKING { return number_.data() + i * kMost; }
  [[nodiscard]] const double* row(std::size_t i) const noexcept PALPATE_NONBLOCKING {
    return number_.data() + i * kMost;
  }
  /// The 3 x 3 block of tools a (rows) and b (columns).
  [[nodiscard]] Mat3 part(std::size_t a, std::size_t b) const noexcept PALPATE_NONBLOCKING;
  void setPart(std::size_t a, std::size_t b, const Mat3& part) noexcept PALPATE_NONBLOCKING;

  /// this -= 1
  void subtractUnit() noexcept PALPATE_NONBLOCKING;

 private:
  std::size_t size_;
  alignas(64) std::array<double, kMost * kMost> number_;  // rows of kMost, of which size_ are used
};

/// A B, both of one size. Cost size^3. Real-time: yes.
[[nodiscard]] SmallSquare product(const SmallSquare& A, const SmallSquare& B) noexcept PALPATE_NONBLOCKING;

/// The X of S X = 1 that leaves least, at a price for its length. Repeated with what is left, so that only what is
/// nearly impossible pays it: of a direction that S shrinks to a tenth 2e-8, to a hundredth 1 %.
///   B = (S^T S + delta^2)^-1 S^T,   X_1 = B,   X_k+1 = X_k + B (1 - S X_k)
/// Cost some 7 size^3. Real-time: yes.
[[nodiscard]] SmallSquare dampedInverse(const SmallSquare& S) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
