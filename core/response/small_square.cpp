// SPDX-License-Identifier: Apache-2.0
#include "core/response/small_square.h"

#include <cmath>

namespace palpate {

namespace {

/// y += a x, rows of n.
void addRow(double a, const double* x, std::size_t n, double* y) noexcept PALPATE_NONBLOCKING {
  for (std::size_t j = 0; j < n; ++j) y[j] += a * x[j];
}

void scaleRow(double a, std::size_t n, double* y) noexcept PALPATE_NONBLOCKING {
  for (std::size_t j = 0; j < n; ++j) y[j] *= a;
}

SmallSquare transposed(const SmallSquare& A) noexcept PALPATE_NONBLOCKING {
  SmallSquare T = A;
  for (std::size_t i = 0; i < A.size(); ++i)
    for (std::size_t j = 0; j < A.size(); ++j) T.row(j)[i] = A.row(i)[j];
  return T;
}

/// The lower L of A = L L^T in A's own place, what is above stays. A is positive definite.
void factorize(SmallSquare& A) noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < A.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double left = A.row(i)[j];
      for (std::size_t k = 0; k < j; ++k) left -= A.row(i)[k] * A.row(j)[k];
      A.row(i)[j] = i == j ? std::sqrt(left) : left / A.row(j)[j];
    }
  }
}

/// B becomes (L L^T)^-1 B.
void solve(const SmallSquare& L, SmallSquare& B) noexcept PALPATE_NONBLOCKING {
  const std::size_t n = L.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) addRow(-L.row(i)[k], B.row(k), n, B.row(i));
    scaleRow(1.0 / L.row(i)[i], n, B.row(i));
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) addRow(-L.row(k)[i], B.row(k), n, B.row(i));
    scaleRow(1.0 / L.row(i)[i], n, B.row(i));
  }
}

}  // namespace

SmallSquare::SmallSquare(std::size_t tools) noexcept PALPATE_NONBLOCKING : size_(3 * tools), number_{} {
  for (std::size_t i = 0; i < size_; ++i) row(i)[i] = 1.0;
}

Mat3 SmallSquare::part(std::size_t a, std::size_t b) const noexcept PALPATE_NONBLOCKING {
  Mat3 part;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = row(3 * a + i)[3 * b + j];
  return part;
}

void SmallSquare::setPart(std::size_t a, std::size_t b, const Mat3& part) noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      row(3 * a + i)[3 * b + j] = part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}

void SmallSquare::subtractUnit() noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < size_; ++i) row(i)[i] -= 1.0;
}

SmallSquare product(const SmallSquare& A, const SmallSquare& B) noexcept PALPATE_NONBLOCKING {
  const std::size_t n = A.size();
  SmallSquare out = A;
  for (std::size_t i = 0; i < n; ++i) {
    scaleRow(0.0, n, out.row(i));
    for (std::size_t k = 0; k < n; ++k) addRow(A.row(i)[k], B.row(k), n, out.row(i));
  }
  return out;
}

SmallSquare dampedInverse(const SmallSquare& S) noexcept PALPATE_NONBLOCKING {
  constexpr double kDamping = 0.005;
  constexpr int kRounds = 3;
  SmallSquare B = transposed(S), normal = product(B, S);
  for (std::size_t i = 0; i < S.size(); ++i) normal.row(i)[i] += kDamping * kDamping;
  factorize(normal);
  solve(normal, B);
  SmallSquare X = B;
  for (int round = 1; round < kRounds; ++round) {
    SmallSquare left = product(S, X);
    left.subtractUnit();
    const SmallSquare change = product(B, left);
    for (std::size_t i = 0; i < S.size(); ++i) addRow(-1.0, change.row(i), S.size(), X.row(i));
  }
  return X;
}

}  // namespace palpate
