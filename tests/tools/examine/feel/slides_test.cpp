// SPDX-License-Identifier: Apache-2.0
// The bounds of palpate-feel slides, on a small organ: a smooth way feels smooth.
#include "tools/examine/feel/slides.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "palpate/testing/paths.h"
#include "palpate/testing/run_program.h"
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

TEST(Slides, TipGoesAtOneSpeedAroundNoCorner) {
  constexpr double kHeight = 3e-3, kStep = 5e-5, kSharpest = 2.0;  // m, m, degrees a step
  std::mt19937 random(1);
  const auto path = feel::randomPath(unevenOrgan(), kHeight, kStep, 0.05, random);
  ASSERT_TRUE(path);
  ASSERT_EQ(path->size(), 1001U);
  const auto tip = [&](std::size_t i) { return Vec3((*path)[i].position + kHeight * (*path)[i].normal); };
  for (std::size_t i = 2; i < path->size(); ++i) {
    const Vec3 last = tip(i - 1) - tip(i - 2), next = tip(i) - tip(i - 1);
    EXPECT_NEAR(next.norm(), kStep, 0.01 * kStep);
    EXPECT_LT(std::atan2(last.cross(next).norm(), last.dot(next)) * 180.0 / std::numbers::pi, kSharpest) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Friction, SlidesWithFriction, ::testing::Values(0.0, 0.05, 0.3));

/// A real, coarse mesh with thin lobes: 432 surface nodes.
class SlidesOnACoarseLiver : public ::testing::TestWithParam<double> {
 protected:
  static std::string mesh() { return dataDir() + "/sofa-liver/liver2.msh"; }
  static const MetaModel* model() {
    static const std::unique_ptr<const MetaModel> model = [] {
      const TemporaryFile organ("coarse.msh"), solved("coarse.h5");
      const bool made = runProgram("palpate-organ", {"import", mesh(), "--scale", "0.0933", "--fixed",
                                                     "lowest-z:0.08", "-o", organ.path().string()})
                                .exit_code == 0 &&
                        runProgram("palpate-solve", {organ.path().string(), "--element-order", "1", "-o",
                                                     solved.path().string(), "-q"})
                                .exit_code == 0;
      return made ? std::make_unique<const MetaModel>(MetaModel::load(solved.path())) : nullptr;
    }();
    return model.get();
  }
};

TEST_P(SlidesOnACoarseLiver, HardlyEverClickOnceTheySlideAndNeverJump) {
  if (!std::filesystem::exists(mesh())) GTEST_SKIP() << mesh() << " is not there";
  ASSERT_NE(model(), nullptr);
  feel::SlideOptions options;
  options.friction = GetParam();
  std::ptrdiff_t clicks = 0;  // of 200 slides
  for (const unsigned seed : {1U, 2U}) {
    options.seed = seed;
    const auto slides = feel::slides(*model(), options);
    clicks += std::ranges::count_if(slides, [](const auto& s) { return s.largest_ratio_later > 1.0; });
    for (const feel::SlideResult& slide : slides)
      EXPECT_LE(slide.largest_slow_step, 0.5 * slide.largest_step);
  }
  EXPECT_LE(clicks, GetParam() > 0.1 ? 11 : 8);
}

INSTANTIATE_TEST_SUITE_P(Friction, SlidesOnACoarseLiver, ::testing::Values(0.0, 0.05, 0.3));

}  // namespace palpate::testing
