// SPDX-License-Identifier: Apache-2.0
#include "core/model/smooth_cubic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace palpate {
namespace {

using Vec2d = Eigen::Vector2d;
using Cubic = SmoothCubic<1>;

struct Function {
  std::function<double(const Vec2d&)> value;
  std::function<Vec2d(const Vec2d&)> gradient;
};

const Function kPolynomial{
    [](const Vec2d& x) {
      return 1.0 + x[0] - 2.0 * x[1] * x[1] + x[0] * x[0] * x[1] + 3.0 * x[1] * x[1] * x[1];
    },
    [](const Vec2d& x) {
      return Vec2d(1.0 + 2.0 * x[0] * x[1], -4.0 * x[1] + x[0] * x[0] + 9.0 * x[1] * x[1]);
    }};
const Function kWave{[](const Vec2d& x) { return std::sin(2.0 * x[0] + x[1]) * std::cos(3.0 * x[1]); },
                     [](const Vec2d& x) {
                       const double p = 2.0 * x[0] + x[1];
                       return Vec2d(
                           2.0 * std::cos(p) * std::cos(3.0 * x[1]),
                           std::cos(p) * std::cos(3.0 * x[1]) - 3.0 * std::sin(p) * std::sin(3.0 * x[1]));
                     }};

using Corners = std::array<Vec2d, 3>;
const Corners kLeft{Vec2d(0.1, 0.0), Vec2d(1.0, 0.2), Vec2d(0.3, 0.9)};
const Corners kRight{Vec2d(1.0, 0.2), Vec2d(1.3, 1.1), Vec2d(0.3, 0.9)};  // shares the edge 1-2 of kLeft

Vec2d pointOf(const Corners& X, const std::array<double, 3>& l) {
  return l[0] * X[0] + l[1] * X[1] + l[2] * X[2];
}

Cubic cubicOf(const Corners& X, const Function& f) {
  Cubic cubic;
  for (std::size_t p = 0; p < 6; ++p) {
    const Vec2d x = p < 3 ? X[p] : Vec2d(0.5 * (X[(p + 1) % 3] + X[(p + 2) % 3]));
    cubic.point[p][0][0] = f.value(x);
    for (std::size_t e = 1; e < 3; ++e) cubic.point[p][e][0] = f.gradient(x).dot(X[e] - X[0]);
  }
  for (std::size_t k = 0; k < 3; ++k) cubic.squares[k] = (X[(k + 1) % 3] - X[(k + 2) % 3]).squaredNorm();
  return cubic;
}

/// Gradient over the plane from the slopes.
Vec2d gradientOf(const Corners& X, const Cubic::Jet& jet) {
  Eigen::Matrix2d E;
  E.row(0) = (X[1] - X[0]).transpose();
  E.row(1) = (X[2] - X[0]).transpose();
  return E.inverse() * Vec2d(jet.slope[1][0] - jet.slope[0][0], jet.slope[2][0] - jet.slope[0][0]);
}

/// Points all over the triangle.
template <typename Visit>
void forPoints(Visit&& visit) {
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; i + j <= 20; ++j) visit({1.0 - (i + j) / 20.0, i / 20.0, j / 20.0});
}

TEST(SmoothCubic, IsExactForCubics) {
  const Cubic cubic = cubicOf(kLeft, kPolynomial);
  forPoints([&](const std::array<double, 3>& l) {
    Cubic::Jet jet;
    cubic.at(l, jet);
    EXPECT_NEAR(jet.value[0], kPolynomial.value(pointOf(kLeft, l)), 1e-13);
    EXPECT_LT((gradientOf(kLeft, jet) - kPolynomial.gradient(pointOf(kLeft, l))).norm(), 1e-12);
  });
}

TEST(SmoothCubic, HasTheGivenValuesAndGradients) {
  const Cubic cubic = cubicOf(kLeft, kWave);
  for (std::size_t p = 0; p < 6; ++p) {
    std::array<double, 3> l{0.5, 0.5, 0.5};
    if (p < 3)
      l = {}, l[p] = 1.0;
    else
      l[p - 3] = 0.0;
    Cubic::Jet jet;
    cubic.at(l, jet);
    EXPECT_NEAR(jet.value[0], kWave.value(pointOf(kLeft, l)), 1e-13) << p;
    EXPECT_LT((gradientOf(kLeft, jet) - kWave.gradient(pointOf(kLeft, l))).norm(), 1e-12) << p;
  }
}

TEST(SmoothCubic, SlopesAreTheDerivatives) {
  const Cubic cubic = cubicOf(kLeft, kWave);
  constexpr double kStep = 1e-6;
  forPoints([&](const std::array<double, 3>& at) {
    const std::array<double, 3> l{0.94 * at[0] + 0.021, 0.94 * at[1] + 0.02, 0.94 * at[2] + 0.019};
    Cubic::Jet jet, ahead, behind;
    cubic.at(l, jet);
    for (std::size_t k = 0; k < 2; ++k) {
      std::array<double, 3> up = l, down = l;
      up[k] += kStep, up[2] -= kStep, down[k] -= kStep, down[2] += kStep;
      cubic.at(up, ahead);
      cubic.at(down, behind);
      EXPECT_NEAR((ahead.value[0] - behind.value[0]) / (2.0 * kStep), jet.slope[k][0] - jet.slope[2][0],
                  1e-5);
    }
  });
}

TEST(SmoothCubic, ValueAndGradientAreContinuousOverAnEdge) {
  const Cubic left = cubicOf(kLeft, kWave), right = cubicOf(kRight, kWave);
  for (int i = 0; i <= 40; ++i) {
    const double t = i / 40.0;
    Cubic::Jet a, b;
    left.at({0.0, 1.0 - t, t}, a);
    right.at({1.0 - t, 0.0, t}, b);
    EXPECT_NEAR(a.value[0], b.value[0], 1e-13) << t;
    EXPECT_LT((gradientOf(kLeft, a) - gradientOf(kRight, b)).norm(), 1e-11) << t;
  }
}

TEST(SmoothCubic, ErrorFallsWithTheFourthPowerOfTheSize) {
  const auto worst = [](double scale) {
    Corners X;
    for (std::size_t k = 0; k < 3; ++k) X[k] = scale * kLeft[k] + Vec2d(0.2, 0.3);
    const Cubic cubic = cubicOf(X, kWave);
    double largest = 0.0;
    forPoints([&](const std::array<double, 3>& l) {
      Cubic::Jet jet;
      cubic.at(l, jet);
      largest = std::max(largest, std::abs(jet.value[0] - kWave.value(pointOf(X, l))));
    });
    return largest;
  };
  EXPECT_GT(worst(0.4) / worst(0.2), 13.0);
  EXPECT_LT(worst(0.4), 1e-3);
}

}  // namespace
}  // namespace palpate
