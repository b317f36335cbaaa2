// SPDX-License-Identifier: Apache-2.0
// How often an interval holds the modulus that a noisy curve was made with.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>
#include <random>

#include "pressed_organ.h"
#include "tools/program/printed.h"

namespace palpate::fit::test {
namespace {

/// Noise of a reading, as parts of the largest force and of its own.
struct Noise {
  double constant, proportional;
};

/// One kind of curve.
struct Kind {
  Noise noise;
  int points;
  bool find_offset;
};

struct Coverage {
  double inside{0.0};  ///< share of curves
  double width{0.0};   ///< mean half width over the modulus
};

MeasuredCurve noisyCurve(const PressedOrgan& organ, const Kind& kind, double scale, double offset,
                         std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double deep = organ.deepest;
  MeasuredCurve curve = organ.curve(kind.points, kind.find_offset ? 0.0 : deep / kind.points,
                                    kind.find_offset ? 1.1 * deep : deep, scale, offset);
  const double largest = scale * organ.press.at(deep).force;
  for (MeasuredPoint& point : curve.points)
    point.force += (kind.noise.constant * largest + kind.noise.proportional * point.force) * normal(random);
  return curve;
}

Coverage coverageOf(const PressedOrgan& organ, const Kind& kind, double confidence, int curves) {
  std::mt19937_64 random(11);
  Coverage coverage;
  for (int run = 0; run < curves; ++run) {
    const double scale = 0.35, offset = kind.find_offset ? (0.1 + 0.1 * run / curves) * organ.deepest : 0.0;
    const MeasuredCurve curve = noisyCurve(organ, kind, scale, offset, random);
    try {
      const Found found =
          estimate(curve, organ.press, {.find_offset = kind.find_offset, .confidence = confidence}).scale;
      coverage.inside += (std::abs(found.value - scale) <= found.halfWidth() ? 1.0 : 0.0) / curves;
      coverage.width += found.halfWidth() / scale / curves;
    } catch (const FitError&) {
      // Refused: counts as outside.
    }
  }
  return coverage;
}

class FitCoverage : public ::testing::TestWithParam<Noise> {};

// Of 100 curves, 95 or more hold the modulus: the default of 99 % is for that.
TEST_P(FitCoverage, TheIntervalHoldsTheModulusAsOftenAsItSays) {
  constexpr int kCurves = 500;
  const PressedOrgan organ;
  std::map<bool, double> before;  // half widths of fewer points
  for (const int points : {5, 12, 60})
    for (const bool find_offset : {false, true}) {
      const Coverage found =
          coverageOf(organ, {GetParam(), points, find_offset}, FitOptions{}.confidence, kCurves);
      std::cout << program::printed(
          "noise %4.1f %% constant, %4.1f %% proportional; %3d points%s: inside %5.1f %%, +- %.3g %%\n",
          100.0 * GetParam().constant, 100.0 * GetParam().proportional, points,
          find_offset ? ", offset" : "        ", 100.0 * found.inside, 100.0 * found.width);
      EXPECT_GT(found.inside, 0.96) << points << " points, offset " << find_offset;
      // Not by being of no use: more points narrow it.
      if (points == 60) {
        EXPECT_LT(found.width, 0.5 * before[find_offset]);
      }
      before[find_offset] = found.width;
    }
}

INSTANTIATE_TEST_SUITE_P(Noises, FitCoverage,
                         ::testing::Values(Noise{0.02, 0.0}, Noise{0.0, 0.02}, Noise{0.01, 0.05},
                                           Noise{0.1, 0.0}));

// A check of the check: an interval that claims less holds the modulus less often.
TEST(Coverage, HalfOfTheCurvesAreOutsideAnIntervalOfHalfTheConfidence) {
  const PressedOrgan organ;
  const Coverage found = coverageOf(organ, {{0.02, 0.0}, 20, false}, 0.5, 1000);
  EXPECT_GT(found.inside, 0.4);
  EXPECT_LT(found.inside, 0.6);
}

}  // namespace
}  // namespace palpate::fit::test
