// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/material.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <string>

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

TEST_P(EveryLaw, RestHasNoStress) {
  check([](auto law) { EXPECT_EQ(law.stress(kLame, Mat3::Zero()), Mat3::Zero()); });
}

/// A turn of 1.2 rad about (1, 2, 3), and of half a turn about x.
TEST_P(EveryLaw, DoesNotFeelTheFrame) {
  check([](auto law) {
    const Mat3 F = Mat3::Identity() + kH;
    for (const Eigen::AngleAxisd& turn : {Eigen::AngleAxisd(1.2, Vec3(1.0, 2.0, 3.0).normalized()),
                                          Eigen::AngleAxisd(3.14159, Vec3::UnitX())}) {
      const Mat3 R = turn.toRotationMatrix();
      const Mat3 turned = R * F - Mat3::Identity();
      EXPECT_NEAR(law.energy(kLame, turned), law.energy(kLame, kH), 1e-12 * kLame.lambda);
      EXPECT_LT((law.stress(kLame, turned) - R * law.stress(kLame, kH)).norm(), 1e-12 * kLame.lambda);
      // Isotropy: the frame of the rest state does not matter either.
      EXPECT_LT((law.stress(kLame, F * R - Mat3::Identity()) - law.stress(kLame, kH) * R).norm(),
                1e-12 * kLame.lambda);
    }
  });
}

TEST_P(EveryLaw, AgreesWithEveryOtherToFirstOrder) {
  check([](auto law) {
    std::array<double, 2> difference{};
    for (std::size_t half = 0; half < 2; ++half) {
      const Mat3 H = (half == 0 ? 2e-4 : 1e-4) * kH;
      difference[half] = (law.stress(kLame, H) - StVenantKirchhoff::stress(kLame, H)).norm();
      EXPECT_LT(difference[half], 1e-3 * law.stress(kLame, H).norm());
    }
    EXPECT_LE(difference[1], 0.26 * difference[0]);  // what is left is of second order
  });
}

/// First Piola-Kirchhoff stresses of diagonal F, by hand.
struct ClosedForms {
  const double lambda = kLame.lambda, mu = kLame.mu, k = lambda + mu;

  double hydrostatic(StVenantKirchhoff /*law*/, double l) const {
    return (1.5 * lambda + mu) * (l * l - 1.0) * l;
  }
  double hydrostatic(StableNeoHookean /*law*/, double l) const {
    return mu * l + (k * (l * l * l - 1.0) - mu) * l * l;
  }
  /// Stretch across a bar of stretch l that nothing holds there: P_across = 0.
  double across(StVenantKirchhoff /*law*/, double l) const {
    const double nu = lambda / (2.0 * (lambda + mu));
    return std::sqrt(1.0 - nu * (l * l - 1.0));
  }
  double across(StableNeoHookean /*law*/, double l) const {
    // 0 = mu + (k (l b^2 - 1) - mu) l, divided by b
    return std::sqrt((k * l + mu * l - mu) / (k * l * l));
  }
  /// E (l^2 - 1) l / 2, and mu l + (k (J - 1) - mu) b^2.
  double along(StVenantKirchhoff /*law*/, double l) const {
    const double E = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
    return 0.5 * E * (l * l - 1.0) * l;
  }
  double along(StableNeoHookean law, double l) const {
    const double b = across(law, l);
    return mu * l + (k * (l * b * b - 1.0) - mu) * b * b;
  }
};

TEST_P(EveryLaw, HasTheStressesOfItsClosedForms) {
  check([](auto law) {
    const ClosedForms form;
    for (const double l : {0.8, 0.95, 1.1, 1.4}) {
      const Mat3 swollen = (l - 1.0) * Mat3::Identity();
      EXPECT_LT((law.stress(kLame, swollen) - form.hydrostatic(law, l) * Mat3::Identity()).norm(),
                1e-12 * kLame.lambda);
      const double b = form.across(law, l);
      const Mat3 pulled = Vec3(l - 1.0, b - 1.0, b - 1.0).asDiagonal();
      const Mat3 wanted = Vec3(form.along(law, l), 0.0, 0.0).asDiagonal();
      EXPECT_LT((law.stress(kLame, pulled) - wanted).norm(), 1e-12 * kLame.lambda) << "stretch " << l;
    }
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

INSTANTIATE_TEST_SUITE_P(Material, EveryLaw, ::testing::ValuesIn(kLaws), [](const auto& test) {
  std::string name(test.param);
  std::erase(name, '-');
  return name;
});

TEST(Material, RefusesALawThatIsNotThereAndListsThoseThatAre) {
  try {
    (void)lawOf("jelly");
    FAIL() << "a law was found";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "= \"jelly\" is not known (known: stvk, stable-neo-hookean)");
  }
}

}  // namespace
}  // namespace palpate::solver
