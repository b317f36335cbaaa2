// SPDX-License-Identifier: Apache-2.0
// The virtual coupling between tool and organ.
#include "core/contact/coupling.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "../round_organ.h"
#include "core/tick/coupling_damper.h"

namespace palpate::testing {

TEST(Coupling, SpringAndOrganCarryTheSameForce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const ContactPoint s = roundOrgan().surface().closestPoint(Vec3(0.01, 0.02, 0.05)).s;
  const PatchResponse patch(roundOrgan(), s);
  for (int trial = 0; trial < 200; ++trial) {
    ContactLaw law;
    law.compliance = 1.0 / std::pow(10.0, 3.0 + 1.5 * uniform(random));
    law.stiffness_scale = std::pow(10.0, uniform(random));
    const Vec3 g = 0.02 * Vec3(uniform(random), uniform(random), uniform(random));
    CoupledResponse out;
    Budget budget;
    ASSERT_NE(couple(patch, g, Carried{}, law, budget, out), ResponseStatus::kNoAnswer);
    EXPECT_LT((out.response.force - (g - out.displacement) / law.compliance).norm(),
              1e-6 * (1.0 + out.response.force.norm()));
    EXPECT_LE(out.stiffness.norm(), 1.01 * std::sqrt(3.0) / law.compliance)
        << "never stiffer than the spring";
  }
}

TEST(Coupling, RenderedStiffnessNeverExceedsTheSprings) {
  StepConfig config = bare(kInfinity);
  config.coupling_stiffness = 300.0;
  config.youngs_modulus = 1e6;
  Driver driver(roundOrgan(), config);
  for (double d = -0.001; d < 0.006; d += 1e-4) {
    const ToolResult& r = driver.at(over(0.0, d));
    const Mat3 K = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.stiffness.data());
    ASSERT_LE(K.operatorNorm(), 300.0 * 1.001) << d;
  }
  EXPECT_GT(vec(driver.result().tools[0].force).norm(), 1.0);
}

TEST(Coupling, DamperTakesTheTimeThatPassedWithoutAForce) {
  const auto after = [](int ticks) {  // the force rises by 1 N in so many ms, and only its end is seen
    CouplingDamper damper;
    Contact contact;
    contact.state = ContactState::kStick;
    contact.normal = Vec3::UnitZ();
    contact.coupled.response.force = Vec3(0.0, 0.0, -1.0);
    (void)damper.force(contact, 0.003, 1e-3);
    for (int i = 1; i < ticks; ++i) damper.wait(1e-3);
    contact.coupled.response.force = Vec3(0.0, 0.0, -2.0);
    return -damper.force(contact, 0.003, 1e-3).z() - 2.0;
  };
  EXPECT_NEAR(after(1), 0.003 * 1000.0 / 3.0, 1e-12);
  EXPECT_NEAR(after(10), 0.003 * 100.0 * 10.0 / 12.0, 1e-12);
}

}  // namespace palpate::testing
