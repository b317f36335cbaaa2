// SPDX-License-Identifier: Apache-2.0
// Models whose parameter is the level of a load of fixed direction.
#include <cmath>

#include "../load_driven.h"

namespace palpate::testing {

namespace {

const MetaModel& levelModel() {
  static const MetaModel model = loadSynthetic({.subdivisions = 2, .parameters = Parameters::kLevel});
  return model;
}

}  // namespace

TEST(LevelModel, LevelThatIsFoundGivesTheDisplacementAlongTheLoad) {
  Random random;
  const MetaModel& model = levelModel();
  const Vec3 e = Eigen::Map<const Vec3>(model.attributes().load_direction.data());
  for (int trial = 0; trial < 200; ++trial) {
    const ContactPoint s = random.contactPoint(model);
    const double t = random.uniform(0.0, SyntheticOptions{}.domain_level);
    const Response load = underLoad(model, s, {t, 0.0, 0.0});
    EXPECT_LT((load.force - t * SyntheticOptions{}.load * e).norm(), 1e-15);
    const Vec3 across = e.cross(random.vector(0.001));  // what the load's direction cannot see
    const Response found = answerTo(model, s, load.displacement + across, ResponseStatus::kOk);
    EXPECT_NEAR(found.parameter.x(), t, 1e-9);
    EXPECT_LT((found.displacement - load.displacement).norm(), 1e-11);
    EXPECT_LT((found.force - load.force).norm(), 1e-9);
  }
}

TEST(LevelModel, LevelsBetweenStepsAreInterpolatedLinearly) {
  const ContactPoint s = atPosition(levelModel(), 3);
  const Vec3 below = underLoad(levelModel(), s, {0.3, 0.0, 0.0}).displacement;
  const Vec3 above = underLoad(levelModel(), s, {0.4, 0.0, 0.0}).displacement;
  const Vec3 between = underLoad(levelModel(), s, {0.325, 0.0, 0.0}).displacement;
  EXPECT_LT((between - (0.75 * below + 0.25 * above)).norm(), 1e-15);
}

TEST(LevelModel, StiffnessIsTheDerivativeOfForce) {
  Random random;
  for (int trial = 0; trial < 50; ++trial) {
    const ContactPoint s = random.contactPoint(levelModel());
    const double t = random.uniform(0.01, 0.84);
    if (std::abs(10.0 * t - std::round(10.0 * t)) < 1e-2) continue;  // a step's kink
    const Vec3 d = underLoad(levelModel(), s, {t, 0.0, 0.0}).displacement;
    const Response here = answerTo(levelModel(), s, d, ResponseStatus::kOk);
    for (Eigen::Index j = 0; j < 3; ++j) {
      const Vec3 h = 1e-7 * Vec3::Unit(j);
      const Vec3 rise = answerTo(levelModel(), s, d + h, ResponseStatus::kOk).force -
                        answerTo(levelModel(), s, d - h, ResponseStatus::kOk).force;
      EXPECT_LT((here.stiffness.col(j) - rise / 2e-7).norm(), 1e-4);
    }
    EXPECT_LT((here.stiffness - underLoad(levelModel(), s, {t, 0.0, 0.0}).stiffness).norm(), 1e-6);
  }
}

TEST(LevelModel, StaysAtItsLastLevelAndAtZero) {
  Random random;
  const ContactPoint s = random.contactPoint(levelModel());
  const Vec3 e = Eigen::Map<const Vec3>(levelModel().attributes().load_direction.data());
  const Response far = answerTo(levelModel(), s, 0.05 * e, ResponseStatus::kBeyond);
  EXPECT_EQ(far.parameter.x(), SyntheticOptions{}.domain_level);
  EXPECT_EQ(far.stiffness, Mat3::Zero());
  EXPECT_NEAR(far.displacement.norm(), far.domain_radius, 1e-15);
  const Response edge = answerTo(levelModel(), s, far.displacement * (1.0 - 1e-9), ResponseStatus::kOk);
  EXPECT_LT((edge.force - far.force).norm(), 1e-7);
  const Response back = answerTo(levelModel(), s, -0.001 * e, ResponseStatus::kBeyond);
  EXPECT_EQ(back.force, Vec3::Zero());
  const Response rest = answerTo(levelModel(), s, Vec3::Zero(), ResponseStatus::kOk);
  EXPECT_EQ(rest.force, Vec3::Zero());
  EXPECT_GT(rest.stiffness.trace(), 0.0);
}

TEST(LevelModel, FindsALevelAmongManySteps) {
  const MetaModel model =
      loadSynthetic({.subdivisions = 1, .parameters = Parameters::kLevel, .level_steps = 99'991});
  const ContactPoint s = atPosition(model, 4);
  for (const double t : {1e-7, 0.123456, 0.5, 0.849999}) {
    const Vec3 d = underLoad(model, s, {t, 0.0, 0.0}).displacement;
    EXPECT_NEAR(answerTo(model, s, d, ResponseStatus::kOk).parameter.x(), t, 1e-9);
  }
}

TEST(LevelModel, PressIsAnsweredAlongTheLoad) {
  const MetaModel& model = levelModel();
  Driver driver(model);
  driver.settle(above(model, -0.002));
  for (double z = -0.002; z < 0.002; z += 1e-4) driver.at(above(model, z));
  const ToolResult& tool = driver.settle(above(model, 0.002));
  EXPECT_EQ(tool.flags, kInContact);
  const Vec3 e = Eigen::Map<const Vec3>(model.attributes().load_direction.data());
  EXPECT_LT(vec(tool.force).cross(e).norm(), 1e-12);
  EXPECT_LT(vec(tool.force).dot(e), 0.0) << "the tool feels the opposite of the load";
}

TEST(LevelModel, WhatIsNoNumberIsAtRest) {
  Random random;
  const ContactPoint s = random.contactPoint(levelModel());
  const double nan = std::nan("");
  Response out;
  EXPECT_EQ(respondToLoad(levelModel(), s, {nan, 0.0, 0.0}, out), ResponseStatus::kBeyond);
  EXPECT_EQ(out.force, Vec3::Zero());
  EXPECT_EQ(out.parameter, Vec3::Zero());
  const Response found = answerTo(levelModel(), s, {nan, 0.0, 0.0}, ResponseStatus::kBeyond);
  EXPECT_EQ(found.force, Vec3::Zero());
  EXPECT_EQ(found.parameter, Vec3::Zero());
}

TEST(LevelModel, ALoadThatOverflowsIsNoForceAndIsFlagged) {
  const MetaModel model =
      spoiled({.subdivisions = 1, .parameters = Parameters::kLevel}, [](modelfile::ModelData& data) {
        data.attributes.load = 1e307;  // its stiffness is not finite
      });
  const Response out = underLoad(model, atPosition(model, 3), {0.5, 0.0, 0.0});
  EXPECT_TRUE(out.force.array().isNaN().all());
  EXPECT_EQ(out.stiffness, Mat3::Zero());
  EXPECT_EQ(out.displacement, Vec3::Zero());
}

TEST(LevelModel, ForceIsContinuousUpToALastLevelThatMissesAStepByTheLastBit) {
  for (const double limit : {std::nextafter(0.3, 0.0), 0.3, std::nextafter(0.3, 1.0), 1e-13, 1.0}) {
    const MetaModel model =
        loadSynthetic({.subdivisions = 1, .parameters = Parameters::kLevel, .domain_level = limit});
    const ContactPoint s = atPosition(model, 4);
    const Vec3 edge = underLoad(model, s, {limit, 0.0, 0.0}).displacement;
    const Response last = answerTo(model, s, edge * (1.0 - 1e-9), ResponseStatus::kOk);
    EXPECT_NEAR(last.parameter.x(), limit, 1e-8 * limit);
    const double slope = underLoad(model, s, {limit * (1.0 - 1e-6), 0.0, 0.0}).stiffness.trace();
    EXPECT_NEAR(last.stiffness.trace(), slope, 1e-6 * slope);
  }
}

TEST(LevelModel, AToolThatIsWithdrawnIsLetGo) {
  const MetaModel& model = levelModel();
  Driver driver(model);
  driver.settle(above(model, -0.002));
  for (double z = -0.002; z < 0.001; z += 1e-4) driver.at(above(model, z));
  driver.settle(above(model, 0.001));
  const ToolResult& tool = driver.settle(above(model, -2e-4));
  EXPECT_EQ(tool.state, static_cast<std::uint32_t>(ContactState::kFree));
  EXPECT_EQ(tool.flags, 0U);
}

}  // namespace palpate::testing
