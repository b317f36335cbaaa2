// SPDX-License-Identifier: Apache-2.0
#include "core/contact/friction_flow.h"

#include <algorithm>
#include <cmath>

#include "core/base/symmetric_eigen.h"

namespace palpate {

namespace {

/// The y of (A + sigma) y = T, and 1 / |y| with its slope, which is nearly linear in sigma.
class Shifted {
 public:
  Shifted(const Vec2& T, const Mat2& A) noexcept PALPATE_NONBLOCKING : eigen_(symmetricEigen<Mat2>(A)),
                                                                       T_(eigen_.vectors.transpose() * T) {}
  struct Inverse {
    double value, slope;
  };
  [[nodiscard]] Inverse inverseLength(double sigma) const noexcept PALPATE_NONBLOCKING {
    const double a = 1.0 / (eigen_.values[0] + sigma), b = 1.0 / (eigen_.values[1] + sigma);
    const double x = square(T_[0] * a), y = square(T_[1] * b);
    const double q = 1.0 / std::sqrt(x + y);
    return {q, q * q * q * (x * a + y * b)};
  }
  [[nodiscard]] double length(double sigma) const noexcept PALPATE_NONBLOCKING { return part(sigma).norm(); }
  [[nodiscard]] Vec2 way(double sigma) const noexcept PALPATE_NONBLOCKING {
    return eigen_.vectors * part(sigma);
  }
  [[nodiscard]] double stiffest() const noexcept PALPATE_NONBLOCKING { return eigen_.values[1]; }

 private:
  [[nodiscard]] static double square(double x) noexcept PALPATE_NONBLOCKING { return x * x; }
  [[nodiscard]] Vec2 part(double sigma) const noexcept PALPATE_NONBLOCKING {
    return {T_[0] / (eigen_.values[0] + sigma), T_[1] / (eigen_.values[1] + sigma)};
  }
  SymmetricEigen<Mat2> eigen_;
  Vec2 T_;
};

/// The sigma where |y| sigma = h. Divided by |y| that is sigma - F q - drag max(0, 1 - free_way q) = 0 with q = 1 / |y|: two
/// pieces, each nearly linear, so Newton's method ends after a few steps (as for a trust region: J. J. More, D. C. Sorensen,
/// SIAM J. Sci. Stat. Comput. 4 (1983) 553-572). A step that leaves the bracket halves it instead.
double sigmaOf(const Shifted& shifted, double friction, double size,
               const Holding& holding) noexcept PALPATE_NONBLOCKING {
  constexpr int kMostSteps = 30;
  constexpr double kTolerance = 1e-10;  // of sigma
  double low = 0.0, high = holding.drag + friction * (shifted.stiffest() + holding.drag) / (size - friction);
  double sigma = high;
  for (int i = 0; i < kMostSteps; ++i) {
    const auto [q, slope] = shifted.inverseLength(sigma);
    const double beyond = 1.0 - holding.free_way * q;
    double left = sigma - friction * q, rise = 1.0 - friction * slope;
    if (beyond > 0.0) {
      left -= holding.drag * beyond;
      rise += holding.drag * holding.free_way * slope;
    }
    if (std::abs(left) <= kTolerance * sigma) return sigma;
    (left < 0.0 ? low : high) = sigma;
    const double next = sigma - left / rise;
    sigma = next > low && next < high ? next : 0.5 * (low + high);
  }
  return high;
}

}  // namespace

double Holding::at(const Vec2& y) const noexcept PALPATE_NONBLOCKING {
  return std::max(0.0, friction + growth.dot(y)) + drag * std::max(0.0, y.norm() - free_way);
}

Vec2 wayAgainst(const Holding& holding, const Vec2& T, const Mat2& A) noexcept PALPATE_NONBLOCKING {
  constexpr int kRounds = 3;  // friction follows from y
  const double size = T.norm();
  const Shifted shifted(T, A);
  Vec2 y = Vec2::Zero();
  for (int i = 0; i < kRounds; ++i) {
    const double friction = std::max(0.0, holding.friction + holding.growth.dot(y));
    if (!(size > friction)) return Vec2::Zero();
    const bool is_free = friction == 0.0 && shifted.length(0.0) <= holding.free_way;
    y = shifted.way(is_free ? 0.0 : sigmaOf(shifted, friction, size, holding));
    if (holding.growth == Vec2::Zero()) break;
  }
  return y;
}

}  // namespace palpate
