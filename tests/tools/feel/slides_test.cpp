// SPDX-License-Identifier: Apache-2.0
// The bounds of palpate-feel slides, on a small organ: a smooth way feels smooth.
#include "palpate/feel/slides.h"

#include <gtest/gtest.h>

#include "uneven_organ.h"

namespace palpate::testing {

namespace {

feel::SlideOptions aDozen(double friction) {
  feel::SlideOptions options;
  options.paths = fewerUnderSanitizers(12);
  options.length = 0.03;
  options.friction = friction;
  return options;
}

std::vector<feel::SlideResult> slidesAt(double friction) {
  const feel::SlideOptions options = aDozen(friction);
  const auto slides = feel::slides(unevenOrgan(), options);
  EXPECT_EQ(static_cast<int>(slides.size()), options.paths);
  return slides;
}

class SlidesWithFriction : public ::testing::TestWithParam<double> {};

}  // namespace

TEST(Slides, ForceWithoutFrictionNeverClicks) {
  for (const feel::SlideResult& slide : slidesAt(0.0))
    EXPECT_LE(slide.largest_ratio, 1.0) << "step of the force / (3 x the median step + 1 % of the force)";
}

TEST_P(SlidesWithFriction, ForceNeitherLagsNorClicksOnceItSlides) {
  for (const feel::SlideResult& slide : slidesAt(GetParam())) {
    EXPECT_EQ(slide.releases, 0);
    EXPECT_GT(slide.mean_force, 0.3);
    EXPECT_LE(slide.largest_lag, 1.0) << "distance to the settled force / its own last step";
    EXPECT_LE(slide.largest_ratio_later, 1.0);
    EXPECT_LE(slide.largest_slow_step, 0.2 * slide.largest_step)
        << "while friction comes up: a slope, no jump";
  }
}

INSTANTIATE_TEST_SUITE_P(Friction, SlidesWithFriction, ::testing::Values(0.0, 0.05, 0.3));

}  // namespace palpate::testing
