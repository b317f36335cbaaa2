// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/estimate.h"

#include <gmock/gmock.h>

#include <cmath>

#include "pressed_organ.h"

namespace palpate::fit::test {
namespace {

using ::testing::HasSubstr;

const PressedOrgan& organ() {
  static const PressedOrgan pressed;
  return pressed;
}

TEST(Estimate, AnExactCurveGivesItsModulusAndWhereContactBegins) {
  const double deep = organ().deepest;
  for (const double scale : {1e-3, 0.35, 1.0, 40.0})
    for (const double offset : {-0.3 * deep, 0.0, 0.02, 0.3}) {
      const MeasuredCurve curve = organ().curve(9, offset - 0.2 * deep, offset + 0.99 * deep, scale, offset);
      const Estimate found = estimate(curve, organ().press, {});
      EXPECT_NEAR(found.scale.value, scale, 1e-7 * scale) << offset;
      EXPECT_NEAR(found.offset.value, offset, 1e-7 * deep) << scale;
      EXPECT_LT(found.scale.halfWidth(), 1e-6 * scale);
      EXPECT_EQ(found.in_contact, 7U);
      EXPECT_EQ(found.beyond, 0U);
    }
}

TEST(Estimate, AbsurdForcesGiveAnAbsurdModulusOrAreRefused) {
  const double deep = organ().deepest;
  for (const bool find_offset : {false, true}) {
    const double offset = find_offset ? 0.1 * deep : 0.0;
    for (const double scale : {1e-40, 1e20, 1e40}) {
      const MeasuredCurve curve = organ().curve(9, 0.0, 1.05 * deep, scale, offset);
      const Estimate found = estimate(curve, organ().press, {.find_offset = find_offset});
      EXPECT_NEAR(found.scale.value, scale, 1e-7 * scale);
      EXPECT_NEAR(found.offset.value, offset, 1e-7 * deep);
    }
    const MeasuredCurve curve = organ().curve(9, 0.0, 1.05 * deep, 1e200, offset);
    EXPECT_THAT(errorOf([&] { (void)estimate(curve, organ().press, {.find_offset = find_offset}); }),
                HasSubstr(", expected at most 1e+100"));
  }
}

TEST(Estimate, WithoutAnOffsetContactBeginsAtZero) {
  const MeasuredCurve curve = organ().curve(5, 0.0, organ().deepest, 0.35);
  const Estimate found = estimate(curve, organ().press, {.find_offset = false});
  EXPECT_NEAR(found.scale.value, 0.35, 1e-12);
  EXPECT_EQ(found.offset.value, 0.0);
  EXPECT_EQ(found.offset.halfWidth(), 0.0);
}

TEST(Estimate, APointWithALargerErrorCountsLess) {
  MeasuredCurve curve = organ().curve(6, 0.0, organ().deepest, 1.0);
  curve.points.back().force *= 1.5;
  const double trusted = estimate(curve, organ().press, {.find_offset = false}).scale.value;
  for (MeasuredPoint& point : curve.points) point.error = 0.01;
  curve.points.back().error = 10.0;
  const double doubted = estimate(curve, organ().press, {.find_offset = false}).scale.value;
  EXPECT_GT(trusted, 1.1);
  EXPECT_NEAR(doubted, 1.0, 1e-4);
}

TEST(Estimate, CountsPointsBeyondTheDomain) {
  const MeasuredCurve curve = organ().curve(11, 0.0, 1.9 * organ().deepest, 1.0);
  EXPECT_EQ(estimate(curve, organ().press, {.find_offset = false}).in_contact, 10U);
  EXPECT_EQ(estimate(curve, organ().press, {.find_offset = false}).beyond, 5U);
}

// Whatever each force of the model is off by, within the share, the interval holds the modulus.
TEST(Estimate, TheModelsOwnErrorIsInTheInterval) {
  constexpr double kShare = 0.01;
  const ModelError model{kShare, 0.05 * organ().press.at(organ().deepest).force};
  std::mt19937 random(3);
  for (int run = 0; run < 200; ++run) {
    const double offset = 0.1 * organ().deepest;
    MeasuredCurve curve = organ().curve(12, 0.0, 1.1 * organ().deepest, 0.5, offset);
    double largest = 0.0;
    for (MeasuredPoint& point : curve.points) {
      point.force *= 1.0 + kShare * (random() % 2 == 0 ? 1.0 : -1.0);
      largest = std::max(largest, point.force);
    }
    const Estimate found = estimate(curve, organ().press, {.model = model});
    EXPECT_LT(std::abs(found.scale.value - 0.5), 1.05 * found.scale.model);  // it is of first order
    EXPECT_LT(std::abs(found.offset.value - offset), 1.05 * found.offset.model);
  }
  const Estimate plain = estimate(organ().curve(5, 0.0, organ().deepest, 0.5), organ().press,
                                  {.find_offset = false, .model = {kShare, 0.0}});
  EXPECT_NEAR(plain.scale.model, kShare * 0.5, 1e-12);
}

TEST(Estimate, RefusesCurvesThatSayNothing) {
  const double deep = organ().deepest;
  const auto refused = [](const MeasuredCurve& curve, bool find_offset) {
    return errorOf([&] { (void)estimate(curve, organ().press, {.find_offset = find_offset}); });
  };
  MeasuredCurve same = organ().curve(2, 0.5 * deep, deep, 1.0);
  same.points.push_back(same.points.back());
  EXPECT_EQ(refused(same, true), "curve.csv has 2 different depths, expected 3 or more");
  EXPECT_EQ(refused({"curve.csv", {}, false}, true), "curve.csv has 0 different depths, expected 3 or more");
  EXPECT_THAT(
      refused(organ().curve(5, -deep, 0.0, 1.0), false),
      HasSubstr("curve.csv: 0 different depths are between contact and r_max = 0.008 m, expected 2 or more; "
                "the deepest is 0 m from contact"));
  // Millimetres that were taken for metres.
  EXPECT_THAT(refused(organ().curve(5, 1.0, 5.0, 1.0), false),
              HasSubstr("curve.csv: 0 different depths are between contact and r_max = 0.008 m"));
  MeasuredCurve pulled = organ().curve(5, 0.2 * deep, deep, 1.0);
  for (MeasuredPoint& point : pulled.points) point.force = -point.force;
  EXPECT_THAT(refused(pulled, false),
              HasSubstr("curve.csv: the force does not rise with depth: the best E is -1 of the model's"));
}

TEST(Press, AMeasuredSizeIsThatOfTheWholeVector) {
  const Vec3 aslant = (-organ().model.surface().normal(organ().anchor.s) + Vec3(0.5, 0.0, 0.0)).normalized();
  const Press along(organ().model, organ().anchor.s, aslant, Measured::kAlong);
  const Press size(organ().model, organ().anchor.s, aslant, Measured::kSize);
  constexpr double kDepth = 0.004, kStep = 1e-7;
  const Vec3 f = query::ask(organ().model, organ().anchor, Vec3(kDepth * aslant)).response.force;
  EXPECT_NEAR(along.at(kDepth).force, f.dot(aslant), 1e-12);
  EXPECT_NEAR(size.at(kDepth).force, f.norm(), 1e-12);
  EXPECT_GT(size.at(kDepth).force, 1.001 * along.at(kDepth).force);
  for (const Press* press : {&along, &size})
    EXPECT_NEAR(press->at(kDepth).slope,
                (press->at(kDepth + kStep).force - press->at(kDepth - kStep).force) / (2.0 * kStep),
                1e-5 * press->at(kDepth).slope);
  EXPECT_EQ(along.at(-1.0).force, 0.0);
}

TEST(Press, RefusesWhereNothingIsPressed) {
  const Vec3 outward = organ().model.surface().normal(organ().anchor.s);
  EXPECT_THAT(errorOf([&] { (void)Press(organ().model, organ().anchor.s, outward, Measured::kAlong); }),
              HasSubstr("does not lead into the organ, whose normal is 0."));
  const query::Anchor bottom = query::anchorNear(organ().model, {0.0, 0.0, -0.05});
  EXPECT_EQ(errorOf([&] {
              (void)Press(organ().model, bottom.s, {0.0, 0.0, 1.0}, Measured::kAlong);
            }),
            "the place is not accessible: the model has no answer there");
}

}  // namespace
}  // namespace palpate::fit::test
