// SPDX-License-Identifier: Apache-2.0
#include "core/base/multi_index.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace palpate {

TEST(MonomialBasis, HoldsEachMonomialOnceByDegree) {
  const MonomialBasis basis(MonomialBasis::kMaxOrder);
  EXPECT_EQ(basis.size(), MonomialBasis::kMaxCoefficients);
  for (int k = 0; k < basis.size(); ++k) {
    EXPECT_EQ(basis.find(basis[k]), k);
    const int degree = basis[k][0] + basis[k][1] + basis[k][2];
    EXPECT_GE(k, basis.begin(degree));
    EXPECT_LT(k, basis.begin(degree + 1));
  }
}

TEST(MonomialBasis, OrderIsThatOfTheFile) {
  const MonomialBasis basis(2);
  const std::vector<MultiIndex> expected{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0}, {1, 1, 0},
                                         {1, 0, 1}, {0, 2, 0}, {0, 1, 1}, {0, 0, 2}};
  ASSERT_EQ(basis.size(), 9);
  for (int k = 0; k < 9; ++k) EXPECT_EQ(basis[k], expected[static_cast<std::size_t>(k)]);
}

TEST(MonomialBasis, FindsNothingOutside) {
  const MonomialBasis basis(2);
  EXPECT_EQ(basis.find({0, 0, 0}), -1);
  EXPECT_EQ(basis.find({3, 0, 0}), -1);
  EXPECT_EQ(basis.find({2, -1, 0}), -1);
}

TEST(MonomialBasis, EvaluatesProductsOfPowers) {
  const MonomialBasis basis(5);
  const Vec3 x(0.3, -1.2, 0.7);
  std::vector<double> values(static_cast<std::size_t>(basis.size()));
  basis.evaluate(x, values);
  for (int k = 0; k < basis.size(); ++k) {
    const MultiIndex a = basis[k];
    const double expected = std::pow(x.x(), a[0]) * std::pow(x.y(), a[1]) * std::pow(x.z(), a[2]);
    EXPECT_NEAR(values[static_cast<std::size_t>(k)], expected, 1e-14);
  }
}

TEST(MonomialBasis, GradientIsTheDerivative) {
  const MonomialBasis basis(4);
  const auto size = static_cast<std::size_t>(basis.size());
  const Vec3 x(0.4, -0.9, 1.1);
  std::vector<Vec3> gradient(size);
  std::vector<double> plus(size), minus(size);
  basis.gradient(x, gradient);
  const double h = 1e-6;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    basis.evaluate(x + h * Vec3::Unit(axis), plus);
    basis.evaluate(x - h * Vec3::Unit(axis), minus);
    for (std::size_t k = 0; k < size; ++k)
      EXPECT_NEAR(gradient[k][axis], (plus[k] - minus[k]) / (2.0 * h), 1e-8);
  }
}

TEST(MonomialBasis, BendsAreTheDerivativesOfTheGradient) {
  const MonomialBasis basis(MonomialBasis::kMaxOrder);
  const auto size = static_cast<std::size_t>(basis.size());
  const Vec3 x(0.4, -0.9, 0.7);
  std::vector<Vec4> jets(size);
  std::vector<Vec6> bends(size);
  std::vector<Vec3> plus(size), minus(size);
  basis.jets(x, jets);
  basis.bends(x, jets, bends);
  const double h = 1e-6;
  constexpr Eigen::Index kEntry[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    basis.gradient(x + h * Vec3::Unit(axis), plus);
    basis.gradient(x - h * Vec3::Unit(axis), minus);
    for (std::size_t k = 0; k < size; ++k)
      for (Eigen::Index i = 0; i < 3; ++i)
        EXPECT_NEAR(bends[k][kEntry[axis][i]], (plus[k][i] - minus[k][i]) / (2.0 * h), 1e-8);
  }
}

TEST(MonomialBasis, RefusesOrdersOutOfRange) {
  for (const int order : {0, 10, -1}) {
    try {
      const MonomialBasis basis(order);
      FAIL() << order;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()),
                "order of the series is " + std::to_string(order) + ", expected 1 to 9");
    }
  }
}

}  // namespace palpate
