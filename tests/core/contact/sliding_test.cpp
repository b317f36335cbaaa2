// SPDX-License-Identifier: Apache-2.0
// Anchors that slide, and poses and tools that jump: physics on the synthetic organ.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "../load_driven.h"
#include "../round_organ.h"
#include "core/base/multi_index.h"
#include "core/contact/contact_solver.h"

namespace palpate::testing {

namespace {

/// Presses at the top and drags to an angle, 0.05 mm a tick.
void drag(Driver& driver, double angle, double depth) {
  for (double d = -0.001; d < depth; d += 5e-5) driver.at(over(0.0, d));
  for (double a = 0.0; a < angle; a += 1e-3) driver.at(over(a, depth));
}

Vec3 normalAt(const ToolResult& r) {
  return testing::normalAt(roundOrgan(), r);
}

}  // namespace

TEST(Sliding, WithoutFrictionTheAnchorStaysBelowTheTool) {
  Driver driver(roundOrgan(), bare(0.0));
  drag(driver, 0.8, 0.002);
  const ToolResult& r = driver.result().tools[0];
  EXPECT_EQ(r.state, static_cast<std::uint32_t>(ContactState::kSlide));
  const Vec3 f = vec(r.force), n = normalAt(r);
  EXPECT_GT(f.dot(n), 0.3);
  EXPECT_LT((f - n * n.dot(f)).norm(), 0.1 * f.norm()) << "what is left is dW/ds";
  EXPECT_LT((vec(r.anchor).normalized() - over(0.8, 0.0).normalized()).norm(), 0.02);
}

TEST(Sliding, FrictionIsWhatCoulombAllows) {
  for (const double mu : {0.05, 0.3, 0.8}) {
    Driver driver(roundOrgan(), bare(mu));
    drag(driver, 0.6, 0.002);
    const ToolResult& r = driver.result().tools[0];
    ASSERT_EQ(r.state, static_cast<std::uint32_t>(ContactState::kSlide)) << mu;
    const Vec3 f = vec(r.force), n = normalAt(r);
    const double pressing = f.dot(n);
    EXPECT_NEAR((f - n * pressing).norm() / pressing, mu, 0.05 * mu) << "dW/ds adds a little to it";
  }
}

TEST(Sliding, WithoutLimitOfFrictionTheAnchorStays) {
  Driver driver(roundOrgan(), bare(kInfinity));
  for (double d = -0.001; d < 0.002; d += 5e-5) driver.at(over(0.0, d));
  const Vec3 anchor = vec(driver.result().tools[0].anchor);
  for (double a = 0.0; a < 0.04; a += 1e-3) ASSERT_EQ(vec(driver.at(over(a, 0.002)).anchor), anchor);
  EXPECT_EQ(driver.result().tools[0].state, static_cast<std::uint32_t>(ContactState::kStick));
}

TEST(Sliding, ForceHasNoClicksOverTrianglesEdgesAndNodes) {
  for (const double azimuth : {0.0, 0.3, 1.1, 2.0, 4.4}) {
    Driver driver(roundOrgan(), bare(0.0));
    for (double d = -0.001; d < 0.002; d += 5e-5) driver.at(over(0.0, d, azimuth));
    Vec3 last = vec(driver.at(over(0.0, 0.002, azimuth)).force);
    std::vector<double> steps;
    for (double a = 1e-3; a < 1.2; a += 1e-3) {
      const Vec3 now = vec(driver.at(over(a, 0.002, azimuth)).force);
      steps.push_back((now - last).norm());
      last = now;
    }
    const double largest = *std::max_element(steps.begin(), steps.end());
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                     steps.end());
    EXPECT_LT(largest, 3.0 * steps[steps.size() / 2] + 0.01 * last.norm()) << azimuth;
  }
}

TEST(Sliding, NoEnergyComesOutOfAClosedWay) {
  for (const double mu : {0.0, 0.05, 0.3}) {
    Driver driver(roundOrgan(), bare(mu));
    double work = 0.0, most = 0.0;
    Vec3 c = over(0.0, -0.001), force = Vec3::Zero();
    const auto to = [&](const Vec3& next) {
      const ToolResult& r = driver.at(next);
      work -= 0.5 * (force + vec(r.force)).dot(next - c);
      force = vec(r.force);
      c = next;
      most = std::max(most, 0.5 * force.norm() * r.penetration);
    };
    for (double d = -0.001; d < 0.002; d += 5e-5) to(over(0.0, d));
    for (double a = 0.0; a < 1.0; a += 1e-3) to(over(a, 0.002));
    for (double d = 0.002; d > -0.002; d -= 5e-5) to(over(1.0, d));
    EXPECT_EQ(force, Vec3::Zero());
    EXPECT_GT(work, -1e-2 * most) << mu;
  }
}

TEST(Sliding, RenderedStiffnessIsTheSlopeOfTheForceWhileSliding) {
  for (const double mu : {0.0, 0.2}) {
    Driver driver(roundOrgan(), bare(mu));
    drag(driver, 0.5, 0.002);
    const Vec3 c = over(0.501, 0.002);
    const Driver before = driver;
    const ToolResult here = driver.at(c);
    for (int j = 0; j < 3; ++j) {
      constexpr double kStep = 1e-6;
      Driver one = before, other = before;
      const Vec3 slope =
          (vec(one.at(c + kStep * Vec3::Unit(j)).force) - vec(other.at(c - kStep * Vec3::Unit(j)).force)) /
          (2.0 * kStep);
      Vec3 rendered;
      for (int i = 0; i < 3; ++i) rendered[i] = here.stiffness[static_cast<std::size_t>(3 * i + j)];
      EXPECT_LT((slope - rendered).norm(), 0.1 * 450.0) << "mu " << mu << ", direction " << j;
    }
  }
}

TEST(Sliding, StopsAtTheBorderOfTheAccessiblePartAndSaysSo) {
  StepConfig config = bare(0.0);
  config.ramp_time = 0.03;  // far from its anchor the tool is let go
  Driver driver(roundOrgan(), config);
  bool flagged = false;
  for (double d = -0.001; d < 0.002; d += 5e-5) driver.at(over(0.0, d));
  Vec3 last = vec(driver.result().tools[0].force);
  for (double a = 0.0; a < 3.1; a += 1e-3) {
    const ToolResult& r = driver.at(over(a, 0.002));
    ASSERT_LT((vec(r.force) - last).norm(), 0.15) << a;
    last = vec(r.force);
    flagged = flagged || (r.flags & kNotAccessible) != 0;
    if (r.state != 0) {  // on the border itself, a little to the inside counts
      const Vec3 inside = vec(r.anchor) + 1e-6 * Vec3::UnitZ();
      ASSERT_TRUE(roundOrgan().surface().reachable(roundOrgan().surface().closestPoint(inside).s.triangle))
          << a;
    }
  }
  EXPECT_TRUE(flagged);
}

TEST(Safety, APoseThatJumpsIsFlaggedAndEngagedAnew) {
  StepConfig config;
  Driver driver(roundOrgan(), config);
  for (double d = -0.001; d < 0.002; d += 5e-5) driver.at(over(0.0, d));
  const ToolResult held = driver.settle(over(0.0, 0.002));
  const ToolResult& leapt = driver.at(over(0.7, 0.002));
  EXPECT_NE(leapt.flags & kPoseJump, 0U);
  EXPECT_LT((vec(leapt.force) - vec(held.force)).norm(), 0.15) << "no step of the force";
  EXPECT_EQ(driver.at(over(0.7, 0.002)).flags & kPoseJump, 0U);
  EXPECT_NEAR(vec(driver.settle(over(0.7, 0.002)).force).norm(), vec(held.force).norm(), 0.4);
}

TEST(Safety, ForceChangesNoFasterThanItsRateLimit) {
  StepConfig config = bare(kInfinity);
  config.force_rate_limit = 50.0;
  Driver driver(roundOrgan(), config);
  Vec3 last = Vec3::Zero();
  bool flagged = false;
  for (double d = -0.001; d < 0.004; d += 5e-4) {
    const ToolResult& r = driver.at(over(0.0, d));
    ASSERT_LE((vec(r.force) - last).norm(), 0.05 + 1e-12);
    flagged = flagged || (r.flags & kForceRateLimited) != 0;
    last = vec(r.force);
  }
  EXPECT_TRUE(flagged);
}

TEST(Safety, WhatOneToolDoesAtOnceTheOtherDoesNotFeelAtOnce) {
  Driver driver(roundOrgan(), StepConfig{});
  const auto place = [&driver](std::size_t tool, const Vec3& c, std::int64_t age_ns) {
    driver.input().tools[tool].present = 1;
    driver.input().tools[tool].position = {c.x(), c.y(), c.z()};
    driver.input().tools[tool].age_ns = age_ns;
  };
  for (double d = -0.001; d < 0.002; d += 5e-5) driver.at(over(0.0, d));
  Vec3 last = vec(driver.settle(over(0.0, 0.002)).force);
  const Vec3 alone = last;
  double moved = 0.0, largest_step = 0.0;
  for (std::int64_t ms = 0; ms < 200;
       ++ms) {  // another one appears deep inside, and falls silent after 60 ms
    place(1, over(0.6, 0.004), std::max<std::int64_t>(0, ms - 60) * 1'000'000);
    const Vec3 now = vec(driver.at(over(0.0, 0.002)).force);
    moved = std::max(moved, (now - alone).norm());
    largest_step = std::max(largest_step, (now - last).norm());
    last = now;
  }
  EXPECT_LT(largest_step, 0.1 * moved) << "a ramp takes 30 ms";
  EXPECT_GT(moved, 0.005) << "it is felt";
  EXPECT_LT((last - alone).norm(), 1e-6) << "and forgotten";
}

TEST(Sliding, AnAnchorThatLosesItsHoldSlidesToItsBalanceWithoutAJump) {
  const ContactSolver solver(0.005);
  Contact contact;
  const auto at = [&](double angle, double friction) {
    solver.update(roundOrgan(), {friction, 0.0, 1.0}, over(angle, 0.002), contact);
    return contact.coupled.response.force;
  };
  for (double depth = -0.001; depth < 0.002; depth += 5e-5)
    solver.update(roundOrgan(), {0.0, 0.0, 1.0}, over(0.0, depth), contact);
  for (double angle = 0.0; angle < 0.05; angle += 1e-3) (void)at(angle, kInfinity);
  Vec3 last = at(0.05, kInfinity);
  const Vec3 stuck = last;
  double largest = 0.0;
  for (int ms = 0; ms < 200; ++ms) {
    const Vec3 now = at(0.05, 0.0);
    ASSERT_FALSE(contact.jumped()) << ms;
    largest = std::max(largest, (now - last).norm());
    last = now;
  }
  EXPECT_LT(largest, 0.4 * (stuck - last).norm()) << "2.7 mm, with the tip at rest, take some ms";
  EXPECT_LT((last - contact.normal * contact.normal.dot(last)).norm(), 0.05 * last.norm()) << "and end";
}

namespace {

/// As stiff along y as `contrast` times along x and z, everywhere.
MetaModel organOfUnequalStiffness(double contrast) {
  constexpr double kStiffness = 300.0;  // N/m
  const SyntheticOptions options;
  return spoiled(options, [&](modelfile::ModelData& data) {
    const MonomialBasis basis(options.order);
    for (std::size_t i = 0; i < data.contact_force.size(); ++i) {
      const MultiIndex alpha = basis[static_cast<int>(i / 3 % static_cast<std::size_t>(basis.size()))];
      const bool linear = alpha[0] + alpha[1] + alpha[2] == 1 && alpha[i % 3] == 1;
      data.contact_force[i] =
          linear ? kStiffness * (i % 3 == 1 ? contrast : 1.0) * options.reference_displacement : 0.0;
    }
    fillStiffness(data, [&](const Vec3&) -> Mat3 {
      return kStiffness * Vec3(1.0, contrast, 1.0).asDiagonal().toDenseMatrix();
    });
  });
}

}  // namespace

TEST(Sliding, FrictionOpposesTheWayAlsoWhereTheOrganIsNotEquallyStiffInAllDirections) {
  const MetaModel uneven = organOfUnequalStiffness(5.0);
  for (const double azimuth : {0.4, 0.8, 1.2}) {
    Driver driver(uneven, bare(0.2));
    for (double depth = -0.001; depth < 0.002; depth += 5e-5) driver.at(over(0.0, depth));
    const Vec3 way(std::cos(azimuth), std::sin(azimuth), 0.0);
    Vec3 c = over(0.0, 0.002), f;
    for (int ms = 0; ms < 100; ++ms) f = vec(driver.at(c += 5e-5 * way).force);
    const Vec3 n = testing::normalAt(uneven, driver.result().tools[0]);
    const Vec3 T = f - n * n.dot(f), along = way - n * n.dot(way);
    EXPECT_LT(std::acos(-T.normalized().dot(along.normalized())), 0.05) << azimuth;  // rad
  }
}

TEST(Sliding, WhereTheTipTurnsFrictionTurnsWithIt) {
  const MetaModel uneven = organOfUnequalStiffness(5.0);
  Driver driver(uneven, bare(0.1));
  for (double depth = -0.001; depth < 0.002; depth += 5e-5) driver.at(over(0.0, depth));
  Vec3 c = over(0.0, 0.002);
  for (int ms = 0; ms < 60; ++ms) driver.at(c += 5e-5 * Vec3::UnitY());
  Vec3 f;
  for (int ms = 0; ms < 10; ++ms)
    f = vec(driver.at(c += 5e-5 * Vec3(std::sin(0.5), std::cos(0.5), 0.0)).force);
  const Vec3 n = testing::normalAt(uneven, driver.result().tools[0]);
  const Vec3 T = f - n * n.dot(f);
  EXPECT_NEAR(std::atan2(T.x(), T.y()) - std::atan2(-std::sin(0.5), -std::cos(0.5)), 0.0, 0.1);
}

}  // namespace palpate::testing
