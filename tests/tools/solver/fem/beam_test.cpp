// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "../boxes.h"
#include "tools/solver/fem/newton.h"

namespace palpate::solver {
namespace {

// docs/design.md, Reproduction: 21 x 9 x 9 nodes, E = 1 MPa, nu = 0.25, one nodal force along -z at (400, 20, 40) mm.
class Beam : public ::testing::Test {
 protected:
  const Box box_{20, 8, 8, Vec3(0.4, 0.04, 0.04)};
  const FeModel model_{box_.clamped({{1e6, 0.25}})};
  const int tip_{box_.node(20, 4, 8)};

  Vec3 tip(double newtons) const {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * model_.nodeCount());
    load[3 * tip_ + 2] = -newtons;
    NewtonOptions options;
    options.steps = 4;
    return NewtonSolver(model_).solveLoad(load, options).u.segment<3>(3 * tip_);
  }
};

TEST_F(Beam, TipOfBeamUnder1NMatchesCalculiX) {
  const Vec3 u = tip(1.0);
  EXPECT_NEAR(u.z(), -74.30193e-3, 1e-5 * 74.30193e-3);
  EXPECT_NEAR(u.x(), -2.698987e-3, 1e-5 * 74.30193e-3);
  EXPECT_NEAR(u.y(), 0.9395896e-3, 1e-5 * 74.30193e-3);
}
TEST_F(Beam, TipOfBeamUnder2NMatchesReference) {
  EXPECT_NEAR(tip(2.0).z(), -139.4827e-3, 1e-5 * 139.4827e-3);
}
TEST_F(Beam, TipOfBeamUnder3NMatchesReference) {
  EXPECT_NEAR(tip(3.0).z(), -189.79699e-3, 1e-5 * 189.79699e-3);
}

}  // namespace
}  // namespace palpate::solver
