// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/ball_moments.h"

#include <Eigen/Cholesky>
#include <array>

namespace palpate::solver {

namespace {

/// Mean of x^alpha over the unit ball; zero unless all exponents are even.
double ballMoment(const std::array<int, 3>& a) {
  const auto odd = [](int n) { return n % 2 != 0; };
  if (odd(a[0]) || odd(a[1]) || odd(a[2])) return 0.0;
  double sphere = 1.0;  // (a_x - 1)!! (a_y - 1)!! (a_z - 1)!! / (n + 1)!!
  int n = 0;
  for (const int exponent : a) {
    for (int k = exponent - 1; k > 1; k -= 2) sphere *= k;
    n += exponent;
  }
  for (int k = n + 1; k > 1; k -= 2) sphere /= k;
  return sphere * 3.0 / (n + 3.0);
}

}  // namespace

Eigen::MatrixXd momentFactor(const MonomialBasis& basis) {
  Eigen::MatrixXd M(basis.size(), basis.size());
  for (int k = 0; k < basis.size(); ++k)
    for (int l = 0; l < basis.size(); ++l)
      M(k, l) = ballMoment({basis[k][0] + basis[l][0], basis[k][1] + basis[l][1], basis[k][2] + basis[l][2]});
  return M.llt().matrixL();
}

}  // namespace palpate::solver
