// SPDX-License-Identifier: Apache-2.0
#include "tools/program/svg_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "palpate/testing/xml_fault.h"

namespace palpate::program {
namespace {

using palpate::testing::xmlFault;

SvgPlot samplePlot() {
  SvgPlot plot;
  plot.title = "a < b & \"c\"";
  plot.x_label = "time / s";
  plot.y_label = "force / N";
  plot.series = {{"one", {0, 1, 2}, {0, 3, 1}, {}}, {"two", {0, 2}, {1, -1}, {}}};
  return plot;
}

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(WellFormed, TheCheckItselfFindsFaults) {
  EXPECT_NE(xmlFault("<a><b></a></b>"), "");
  EXPECT_NE(xmlFault("<a x=\"1></a>"), "");
  EXPECT_NE(xmlFault("<a>"), "");
  EXPECT_NE(xmlFault("<a>b & c</a>"), "");
  EXPECT_EQ(xmlFault("<?xml?><a x=\"1\">b &amp; c<d/></a>"), "");
}

TEST(Svg, IsWellFormedAndEscapesText) {
  const std::string svg = samplePlot().render();
  EXPECT_EQ(xmlFault(svg), "");
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_EQ(countOf(svg, "<polyline"), 2U);
  EXPECT_NE(svg.find(">force / N<"), std::string::npos);
  EXPECT_NE(svg.find("prefers-color-scheme: dark"), std::string::npos);
}

TEST(Svg, EveryPointLiesInThePlot) {
  const std::string svg = samplePlot().render();
  const std::size_t start = svg.find("points=\"") + 8;
  double x = 0.0, y = 0.0;
  ASSERT_EQ(std::sscanf(svg.c_str() + start, "%lf,%lf", &x, &y), 2);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_NEAR(x, 70.0, 1e-9);  // x = 0 on the axis
  EXPECT_GT(y, 48.0);
  EXPECT_LT(y, 420.0 - 52.0);
}

TEST(Svg, BarsOnLogarithmicAxesSkipZeros) {
  SvgPlot plot;
  plot.log_x = plot.log_y = true;
  plot.series = {{"h", {10, 20, 40}, {1000, 0, 1}, {20, 40, 80}}};
  const std::string svg = plot.render();
  EXPECT_EQ(xmlFault(svg), "");
  EXPECT_EQ(countOf(svg, "<rect class=\"bar"), 2U);
}

TEST(Svg, MarksAndBandsAreDrawnAndNamed) {
  SvgPlot plot;
  plot.width = 480;
  plot.log_y = true;
  plot.log_floor = 0.01;
  plot.series = {{"band", {0, 1}, {1, 2}, {}, {2, 4}},
                 {"discs", {0, 1}, {1, 0.0001}, {}, {}, Look::kDiscs},
                 {"frames", {0, 1}, {1, 2}, {}, {}, Look::kFrames, 0}};
  const std::string svg = plot.render();
  EXPECT_EQ(xmlFault(svg), "");
  EXPECT_NE(svg.find("width=\"480\""), std::string::npos);
  EXPECT_EQ(countOf(svg, "<polygon class=\"band c0\""), 1U);
  EXPECT_EQ(countOf(svg, "<circle class=\"mark c1\""), 3U);  // one in the legend
  EXPECT_EQ(countOf(svg, "<rect class=\"mark c0 hollow\""), 3U);
  EXPECT_NE(svg.find("cy=\"368\""), std::string::npos) << "what is below the floor sits on it";
}

TEST(Svg, OfNothingOrOneValueStillHasAxes) {
  SvgPlot plot;
  EXPECT_EQ(xmlFault(plot.render()), "");
  plot.log_x = true;
  plot.series = {{"one", {5}, {0}, {}}};
  const std::string svg = plot.render();
  EXPECT_EQ(xmlFault(svg), "");
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Svg, RejectsNumbersItCannotShow) {
  SvgPlot plot;
  plot.series = {{"bad", {0, 1}, {0, std::nan("")}, {}}};
  EXPECT_THROW((void)plot.render(), std::invalid_argument);
  plot.series = {{"odd", {0, 1}, {0}, {}}};
  EXPECT_THROW((void)plot.render(), std::invalid_argument);
  plot.series = {{"odd band", {0, 1}, {0, 1}, {}, {1}}};
  EXPECT_THROW((void)plot.render(), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::program
