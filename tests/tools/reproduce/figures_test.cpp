// SPDX-License-Identifier: Apache-2.0
#include "palpate/reproduce/figures.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace palpate::reproduce {
namespace {

class Figures : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v gnuplot > /dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    std::ostringstream out;
    out << file.rdbuf();
    return out.str();
  }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("palpate_figures_test_" + std::to_string(getpid()));
};

TEST_F(Figures, ChartNamesItsCurvesAndAxes) {
  const Chart chart{"Error", "step", "error", true, true, {{"ten \"terms\"", {{0.1, 1e-3}, {0.01, 1e-5}}}}};
  ASSERT_TRUE(drawChart(folder_ / "chart.svg", chart));
  const std::string svg = text("chart.svg");
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
  EXPECT_EQ(text("surface.png").substr(1, 3), "PNG");
}

TEST_F(Figures, FolderThatIsNotThereIsReported) {
  EXPECT_FALSE(
      drawChart(folder_ / "nowhere" / "chart.svg", {"", "x", "y", false, false, {{"c", {{1, 1}, {2, 2}}}}}));
}

}  // namespace
}  // namespace palpate::reproduce
