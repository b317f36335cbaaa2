// SPDX-License-Identifier: Apache-2.0
// What one tool's contact may cost in one tick, and what comes of a search that would cost more.
#include "core/base/budget.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "../load_driven.h"
#include "core/contact/contact_solver.h"

namespace palpate::testing {

namespace {

constexpr double kTip = 0.005;     // m
constexpr int kEndless = 1 << 28;  // evaluations
constexpr int kMostOfAStep = 16;   // a place, and what a search at it evaluates before it asks again

/// Coefficients of higher order that are no model's: d(f) folds, turns back, and has several branches.
void scramble(modelfile::ModelData& data) {
  Random random;
  const std::size_t width = static_cast<std::size_t>(3 * MonomialBasis::size(3)), linear = 9;
  std::vector<double> bad(width - linear);
  for (double& number : bad) number = random.uniform(-0.0015, 0.0015);
  for (std::size_t i = 0; i < data.contact_displacement.size(); i += width)
    std::copy(bad.begin(), bad.end(), data.contact_displacement.begin() + std::ptrdiff_t(i + linear));
}

const MetaModel& folded() {
  static const MetaModel model = spoiled(forceOptions(3), scramble);
  return model;
}

/// Walks that look for the most expensive tick: deep and beyond the domain, to and fro, over borders, with every
/// friction, coupling and stiffness. Calls visit(budget, contact) after each tick.
template <typename Visit>
void hunt(const MetaModel& model, int evaluations, int walks, Visit&& visit) {
  constexpr std::array<double, 3> kFriction{0.0, 0.05, 0.3};
  constexpr std::array<double, 4> kCompliance{0.0, 1e-5, 1.0 / 300.0, 0.02};
  constexpr int kTicks = 100;
  Random random;
  const ContactSolver solver(kTip);
  for (int walk = 0; walk < walks; ++walk) {
    const ContactLaw law{kFriction[std::size_t(walk) % 3], kCompliance[std::size_t(walk) % 4],
                         std::pow(10.0, random.uniform(-1.5, 1.5))};
    const ContactPoint s = random.contactPoint(model);
    const Vec3 from = model.surface().position(s) + 0.9 * kTip * model.surface().normal(s);
    const double depth = random.uniform(0.0, 0.03);
    Contact contact;
    Vec3 c = from;
    for (int tick = 0; tick < kTicks; ++tick) {
      Budget budget(evaluations);
      solver.update(model, law, c, TipWay::kStraight, budget, contact);
      visit(budget, contact);
      c = walk % 2 == 0 ? Vec3(c + random.vector(2e-3)) : Vec3(from + random.vector(depth));
    }
  }
}

int mostUsed(const MetaModel& model, int evaluations) {
  int most = 0;
  hunt(model, evaluations, 48,
       [&](const Budget& budget, const Contact&) { most = std::max(most, budget.used()); });
  return most;
}

}  // namespace

TEST(Budget, NoTickCostsMoreThanItsBudget) {
  for (const MetaModel* model : {&folded(), &forceModel()})
    EXPECT_LE(mostUsed(*model, Budget::kEvaluations), Budget::kEvaluations + kMostOfAStep);
}

TEST(Budget, WithoutItALoadDrivenModelNeedsManyTimesAsMuch) {
  EXPECT_GT(mostUsed(folded(), kEndless), 8 * Budget::kEvaluations) << "the walks above find nothing dear";
}

TEST(Budget, ADisplacementDrivenModelIsNeverCutShort) {
  const MetaModel model = loadSynthetic({.subdivisions = 2, .nonlinearity = 1.0, .contrast = 0.5});
  hunt(model, Budget::kEvaluations, 48, [](const Budget& budget, const Contact& contact) {
    EXPECT_FALSE(budget.cut());
    EXPECT_EQ(contact.flags & kAnswerCutShort, 0U);
  });
}

TEST(Budget, AnAnswerCutShortIsFlaggedAndBoundedAndNeverPulls) {
  for (const int evaluations : {1, 9, 30, 100, 300}) {
    int cut = 0;
    hunt(folded(), evaluations, 48, [&](const Budget& budget, const Contact& contact) {
      const Vec3& f = contact.coupled.response.force;
      cut += budget.cut() ? 1 : 0;
      EXPECT_EQ((contact.flags & kAnswerCutShort) != 0, budget.cut());
      EXPECT_TRUE(f.allFinite() && contact.stiffness.allFinite());
      EXPECT_LE(f.norm(), 32.0 * forceOptions().domain_force) << "f_max times the scale";
      EXPECT_LE(f.dot(contact.normal), 0.0);
    });
    EXPECT_GT(cut, 0) << evaluations;
  }
}

TEST(Budget, WhatWasCutShortIsFinishedInTheNextTicks) {
  const MetaModel model = loadSynthetic({.subdivisions = 2, .contrast = 0.5});
  const ContactLaw law{0.1, 1.0 / 300.0, 1.0};
  const ContactSolver solver(kTip);
  Contact whole, pieces;
  const Vec3 down = above(model, 0.002), aside = down + Vec3(0.01, 0.004, 0.0);
  for (int tick = 0; tick < 20; ++tick) {
    for (Contact* contact : {&whole, &pieces}) solver.update(model, law, down, *contact);
  }
  for (int tick = 0; tick < 30; ++tick) {
    Budget little(60);
    solver.update(model, law, aside, whole);
    solver.update(model, law, aside, TipWay::kStraight, little, pieces);
    EXPECT_TRUE(tick > 0 || little.cut());
    EXPECT_FALSE(tick == 29 && little.cut());
  }
  EXPECT_LT((whole.coupled.response.force - pieces.coupled.response.force).norm(),
            0.02 * whole.coupled.response.force.norm());
}

TEST(Budget, OneSpentBeforeTheFirstAnswerHoldsTheForce) {
  const ContactSolver solver(kTip);
  const ContactLaw law{0.3, 1.0 / 300.0, 1.0};
  Contact contact;
  for (double depth = 0.0; depth < 0.002; depth += 1e-4)
    solver.update(forceModel(), law, above(forceModel(), depth), contact);
  const Vec3 before = contact.coupled.response.force;
  Budget none(0);
  solver.update(forceModel(), law, above(forceModel(), 0.0025), TipWay::kStraight, none, contact);
  EXPECT_EQ(contact.coupled.response.force, before);
  EXPECT_NE(contact.flags & kAnswerCutShort, 0U);
}

TEST(Budget, OneSpentWithinTheSearchForAForceAnswersWhatTheSearchCameTo) {
  constexpr int kFewSteps = 8;
  Random random;
  int cut = 0;
  for (int i = 0; i < 50; ++i) {
    const ContactPoint s = random.contactPoint(forceModel());
    const Vec3 load = 0.9 * forceOptions().domain_force * random.inBall(1.0);
    const Vec3 d = underLoad(forceModel(), s, load).displacement;
    Budget few(kFewSteps);
    Response out;
    (void)PatchResponse(forceModel(), s).at(d, few, out);
    cut += few.cut() ? 1 : 0;
    EXPECT_LT((out.displacement - d).norm(), 0.5 * d.norm());
  }
  EXPECT_GT(cut, 0);
}

TEST(Budget, TheToolIsToldThatItsAnswerWasCutShort) {
  StepConfig config;
  config.friction = 0.05;
  config.coupling_stiffness = 300.0;
  config.force_limit = 3.3;
  Random random;
  std::uint32_t flags = 0;
  for (int walk = 0; walk < 12; ++walk) {
    Driver driver(folded(), config);
    Vec3 c = above(folded(), 0.001);
    for (int tick = 0; tick < 200; ++tick, c += random.vector(1.5e-3)) {
      const ToolResult& r = driver.at(c);
      ASSERT_TRUE(vec(r.force).allFinite());
      ASSERT_LE(vec(r.force).norm(), 1.000001 * config.force_limit);
      flags |= r.flags;
    }
  }
  EXPECT_NE(flags & kAnswerCutShort, 0U);
}

}  // namespace palpate::testing
