// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/field_measures.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "../boxes.h"

namespace palpate::solver {
namespace {

class Block : public ::testing::Test {
 protected:
  const Box box_{2, 3, 2, Vec3(0.02, 0.03, 0.05)};
  const FeModel model_{box_.clamped({{160e3, 0.3}})};

  Eigen::VectorXd field(const Mat3& H) const {
    Eigen::VectorXd u(3 * model_.nodeCount());
    for (int i = 0; i < model_.nodeCount(); ++i)
      u.segment<3>(3 * i) = H * model_.nodes()[static_cast<std::size_t>(i)];
    return u;
  }
};

TEST_F(Block, StretchGainsTheProductOfItsStretches) {
  const Mat3 H = Vec3(0.1, -0.2, 0.3).asDiagonal();
  EXPECT_NEAR(volumeChange(model_, field(H)), 1.1 * 0.8 * 1.3 - 1.0, 1e-13);
}

TEST_F(Block, RotationGainsNoVolumeButItsLinearizationDoes) {
  const Mat3 R = Eigen::AngleAxisd(0.5, Vec3::UnitY()).toRotationMatrix();
  EXPECT_NEAR(volumeChange(model_, field(R - Mat3::Identity())), 0.0, 1e-13);
  Mat3 spin = Mat3::Zero();
  spin(0, 2) = 0.5;
  spin(2, 0) = -0.5;
  EXPECT_NEAR(volumeChange(model_, field(spin)), 0.25, 1e-13);
}

TEST_F(Block, NormOfALinearFieldIsItsIntegral) {
  Mat3 H = Mat3::Zero();
  H(1, 0) = 2.0;  // |u|^2 = 4 x^2
  EXPECT_NEAR(normL2(model_, field(H)), std::sqrt(4.0 / 3.0 * std::pow(0.02, 3) * 0.03 * 0.05), 1e-12);
}

TEST_F(Block, ErrorOfAFieldThatIsTenPercentShort) {
  const Eigen::VectorXd u = field(Mat3::Random());
  EXPECT_NEAR(relativeErrorL2(model_, 0.9 * u, u), 0.1, 1e-13);
  EXPECT_THROW((void)relativeErrorL2(model_, u, 0.0 * u), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::solver
