// SPDX-License-Identifier: Apache-2.0
#include "core/contact/friction_flow.h"

#include <algorithm>

#include "core/base/symmetric_eigen.h"

namespace palpate {

namespace {

/// |y| for a sigma, and the y, of (A + sigma) y = T.
class Shifted {
 public:
  Shifted(const Vec2& T, const Mat2& A) noexcept PALPATE_NONBLOCKING : eigen_(symmetricEigen<Mat2>(A)),
                                                                       T_(eigen_.vectors.transpose() * T) {}
  [[nodiscard]] double length(double sigma) const noexcept PALPATE_NONBLOCKING { return part(sigma).norm(); }
  [[nodiscard]] Vec2 way(double sigma) const noexcept PALPATE_NONBLOCKING {
    return eigen_.vectors * part(sigma);
  }
  [[nodiscard]] double stiffest() const noexcept PALPATE_NONBLOCKING { return eigen_.values[1]; }

 private:
  [[nodiscard]] Vec2 part(double sigma) const noexcept PALPATE_NONBLOCKING {
    return {T_[0] / (eigen_.values[0] + sigma), T_[1] / (eigen_.values[1] + sigma)};
  }
  SymmetricEigen<Mat2> eigen_;
  Vec2 T_;
};

/// The sigma where |y| sigma = h; what is left of it grows with sigma.
double sigmaOf(const Shifted& shifted, double friction, double size,
               const Holding& holding) noexcept PALPATE_NONBLOCKING {
  constexpr int kHalvings = 30;
  double low = 0.0, high = holding.drag + friction * (shifted.stiffest() + holding.drag) / (size - friction);
  for (int i = 0; i < kHalvings; ++i) {
    const double sigma = 0.5 * (low + high), length = shifted.length(sigma);
    const double h = friction + holding.drag * std::max(0.0, length - holding.free_way);
    (length * sigma < h ? low : high) = sigma;
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
