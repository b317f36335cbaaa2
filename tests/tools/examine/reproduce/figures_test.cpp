// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/figures.h"

#include <gtest/gtest.h>

#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"

namespace palpate::reproduce {
namespace {

class Figures : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!palpate::testing::isInstalled("gnuplot")) GTEST_SKIP() << "gnuplot is not installed";
  }
  const palpate::testing::TemporaryFolder folder_;
};

TEST_F(Figures, ChartNamesItsCurvesAndAxes) {
  const Chart chart{"Error", "step", "error", true, true, {{"ten \"terms\"", {{0.1, 1e-3}, {0.01, 1e-5}}}}};
  ASSERT_TRUE(drawChart(folder_ / "chart.svg", chart));
  const std::string svg = palpate::testing::contentOf(folder_ / "chart.svg");
  EXPECT_NE(svg.find("ten terms"), std::string::npos);
  EXPECT_NE(svg.find("step"), std::string::npos);
}

TEST_F(Figures, PointsThatALogarithmCannotShowAreLeftOut) {
  const Chart chart{"", "x", "y", true, true, {{"curve", {{0.0, 1.0}, {1.0, 0.0}, {1.0, 2.0}, {2.0, 3.0}}}}};
  EXPECT_TRUE(drawChart(folder_ / "log.svg", chart));
}

TEST_F(Figures, SurfaceIsAPng) {
  const SurfacePanel panel{"tetrahedron",
                           {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                           {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}},
                           {-1.0, 0.0, 0.5, 1.0}};
  SurfaceFigure figure;
  figure.panels = {panel, panel};
  ASSERT_TRUE(drawSurfaces(folder_ / "surface.png", figure));
  EXPECT_EQ(palpate::testing::contentOf(folder_ / "surface.png").substr(1, 3), "PNG");
}

TEST_F(Figures, FolderThatIsNotThereIsReported) {
  EXPECT_FALSE(
      drawChart(folder_ / "nowhere" / "chart.svg", {"", "x", "y", false, false, {{"c", {{1, 1}, {2, 2}}}}}));
}

}  // namespace
}  // namespace palpate::reproduce
