// SPDX-License-Identifier: Apache-2.0
#include "core/contact/friction_flow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/symmetric_eigen.h"

namespace palpate {

namespace {

/// The y of (A + sigma) y = T, and what of it friction depends on.
class Shifted {
 public:
  Shifted(const Vec2& T, const Mat2& A, const Vec2& growth) noexcept PALPATE_NONBLOCKING
      : eigen_(symmetricEigen<Mat2>(A)),
        T_(eigen_.vectors.transpose() * T),
        growth_(eigen_.vectors.transpose() * growth) {}
  /// 1 / |y|, nearly linear in sigma, and growth . y; each with its slope.
  struct Way {
    double inverse, inverse_slope, grown, grown_slope;
  };
  [[nodiscard]] Way at(double sigma) const noexcept PALPATE_NONBLOCKING {
    const Vec2 a(1.0 / (eigen_.values[0] + sigma), 1.0 / (eigen_.values[1] + sigma));
    const Vec2 y = T_.cwiseProduct(a), rate = -y.cwiseProduct(a);
    const double q = 1.0 / y.norm();
    return {q, -q * q * q * y.dot(rate), growth_.dot(y), growth_.dot(rate)};
  }
  [[nodiscard]] Vec2 way(double sigma) const noexcept PALPATE_NONBLOCKING {
    return eigen_.vectors * Vec2(T_[0] / (eigen_.values[0] + sigma), T_[1] / (eigen_.values[1] + sigma));
  }
  [[nodiscard]] double stiffest() const noexcept PALPATE_NONBLOCKING { return eigen_.values[1]; }

 private:
  SymmetricEigen<Mat2> eigen_;
  Vec2 T_, growth_;
};

/// The sigma where |y| sigma = h. Divided by |y| that is sigma - F q - drag max(0, 1 - free_way q) = 0 with q = 1 / |y| and
/// F = max(0, friction + growth . y): pieces that are nearly linear, so Newton's method ends after a few steps (as for a trust
/// region: J. J. More, D. C. Sorensen, SIAM J. Sci. Stat. Comput. 4 (1983) 553-572). A step that leaves the bracket halves it
/// instead. There is a root: at sigma = 0 the left side is not positive, and in the end it grows where |T| is more than F.
double sigmaOf(const Shifted& shifted, double size, const Holding& holding) noexcept PALPATE_NONBLOCKING {
  constexpr int kMostSteps = 30;
  constexpr double kTolerance = 1e-10;  // of sigma
  const double at_rest = std::max(0.0, holding.friction);
  double low = 0.0, high = std::numeric_limits<double>::infinity();
  double sigma = holding.drag + at_rest * (shifted.stiffest() + holding.drag) / (size - at_rest);
  for (int i = 0; i < kMostSteps; ++i) {
    const Shifted::Way y = shifted.at(sigma);
    const double friction = holding.friction + y.grown, beyond = 1.0 - holding.free_way * y.inverse;
    double left = sigma, rise = 1.0;
    if (friction > 0.0) {
      left -= friction * y.inverse;
      rise -= friction * y.inverse_slope + y.grown_slope * y.inverse;
    }
    if (beyond > 0.0) {
      left -= holding.drag * beyond;
      rise += holding.drag * holding.free_way * y.inverse_slope;
    }
    if (std::abs(left) <= kTolerance * sigma) return sigma;
    (left < 0.0 ? low : high) = sigma;
    const double next = sigma - left / rise;
    if (next > low && next < high)
      sigma = next;
    else
      sigma = high < std::numeric_limits<double>::infinity() ? 0.5 * (low + high)
                                                             : 2.0 * low + shifted.stiffest();
  }
  return sigma;
}

}  // namespace

double Holding::at(const Vec2& y) const noexcept PALPATE_NONBLOCKING {
  return std::max(0.0, friction + growth.dot(y)) + drag * std::max(0.0, y.norm() - free_way);
}

Vec2 wayAgainst(const Holding& holding, const Vec2& T, const Mat2& A) noexcept PALPATE_NONBLOCKING {
  const double size = T.norm();
  if (!(size > std::max(0.0, holding.friction))) return Vec2::Zero();
  const Shifted shifted(T, A, holding.growth);
  return shifted.way(sigmaOf(shifted, size, holding));
}

}  // namespace palpate
