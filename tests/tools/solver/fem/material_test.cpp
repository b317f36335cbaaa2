// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/material.h"

#include <gtest/gtest.h>

#include "core/data/model_view.h"

namespace palpate::solver {
namespace {

const Lame kLame = Elasticity{160e3, 0.4}.lame();
const Mat3 kH = (Mat3() << 0.1, 0.05, -0.02, 0.03, -0.08, 0.04, 0.0, 0.06, 0.12).finished();

/// Every law that model files may name.
class EveryLaw : public ::testing::TestWithParam<std::string_view> {
 protected:
  template <typename Check>
  void check(const Check& body) {
    std::visit(body, lawOf(GetParam()));
  }
};

TEST_P(EveryLaw, StressIsTheDerivativeOfEnergy) {
  check([](auto law) {
    const double h = 1e-6;
    Mat3 difference;
    for (int i = 0; i < 3; ++i)
      for (int J = 0; J < 3; ++J) {
        Mat3 step = Mat3::Zero();
        step(i, J) = h;
        difference(i, J) = (law.energy(kLame, kH + step) - law.energy(kLame, kH - step)) / (2.0 * h);
      }
    EXPECT_LT((law.stress(kLame, kH) - difference).norm(), 1e-8 * difference.norm());
  });
}

TEST_P(EveryLaw, TangentIsTheDerivativeOfStress) {
  check([](auto law) {
    const Eigen::Matrix<double, 4, 3> g =
        (Eigen::Matrix<double, 4, 3>() << -1, -2, -3, 1, 0.5, 0.2, -0.3, 1, 0.7, 0.3, 0.5, 2.1).finished();
    const Eigen::Matrix<double, 12, 12> K = law.tangent(kLame, kH, g);
    const double h = 1e-6;
    for (int b = 0; b < 4; ++b)
      for (int j = 0; j < 3; ++j) {
        const Mat3 step = h * Vec3::Unit(j) * g.row(b);
        const Mat3 dP = (law.stress(kLame, kH + step) - law.stress(kLame, kH - step)) / (2.0 * h);
        for (int a = 0; a < 4; ++a)
          EXPECT_LT((K.block<3, 1>(3 * a, 3 * b + j) - dP * g.row(a).transpose()).norm(), 1e-7 * K.norm());
      }
  });
}

TEST_P(EveryLaw, IsLinearElasticityAtRest) {
  check([](auto law) {
    const Mat3 eps = 1e-8 * (kH + kH.transpose());
    const Mat3 wanted = kLame.lambda * eps.trace() * Mat3::Identity() + 2.0 * kLame.mu * eps;
    EXPECT_LT((law.stress(kLame, eps) - wanted).norm(), 1e-6 * wanted.norm());
    EXPECT_EQ(law.energy(kLame, Mat3::Zero()), 0.0);
  });
}

TEST_P(EveryLaw, RefusesNumbersThatNoMaterialHas) {
  check([](auto law) {
    EXPECT_NO_THROW(law.check({160e3, 0.48}));
    EXPECT_THROW(law.check({0.0, 0.3}), std::invalid_argument);
    EXPECT_THROW(law.check({160e3, 0.5}), std::invalid_argument);
    EXPECT_THROW(law.check({160e3, -1.0}), std::invalid_argument);
  });
}

INSTANTIATE_TEST_SUITE_P(Material, EveryLaw, ::testing::ValuesIn(kLaws),
                         [](const auto& test) { return std::string(test.param); });

TEST(Material, RefusesALawThatIsNotThereAndListsThoseThatAre) {
  try {
    (void)lawOf("jelly");
    FAIL() << "a law was found";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "= \"jelly\" is not known (known: stvk)");
  }
}

}  // namespace
}  // namespace palpate::solver
