// SPDX-License-Identifier: Apache-2.0
#include "tools/program/svg_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "palpate/testing/xml_fault.h"
#include "tools/program/spread.h"

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

// Number after each `before`, from the first place that `from` is found.
std::vector<double> numbersAfter(const std::string& text, const std::string& from,
                                 const std::string& before) {
  std::vector<double> numbers;
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1))
    numbers.push_back(std::stod(text.substr(text.find(before, at) + before.size())));
  return numbers;
}

TEST(Svg, NamesOfCurvesStandWhereTheyEndAndNotOverEachOther) {
  SvgPlot plot;
  plot.series = {
      {"one", {0, 1, 2}, {0, 3, 1}, {}}, {"two", {0, 2}, {2, 1}, {}}, {"three", {0, 1}, {0, 3}, {}}};
  const std::string svg = plot.render();
  EXPECT_EQ(xmlFault(svg), "");
  EXPECT_EQ(svg.find("class=\"curve c0\" x1"), std::string::npos) << "no legend above";
  const auto ends = numbersAfter(svg, "<line class=\"leader", "y1=\"");
  const auto names = numbersAfter(svg, "<line class=\"leader", "y2=\"");
  ASSERT_EQ(names.size(), 3U);
  EXPECT_NEAR(ends[0], ends[1], 1e-9) << "both end at 1";
  EXPECT_GE(std::abs(names[0] - names[1]), 14.0) << "a line of text is 12 px high";
  EXPECT_NEAR(names[0], ends[0], 18.0);
  EXPECT_NEAR(names[2], ends[2], 1e-3) << "nothing is in its way";
  const double frame = numbersAfter(svg, "<line class=\"axis", "x2=\"")[0];
  for (const double x : numbersAfter(svg, "<line class=\"leader", "x2=\"")) EXPECT_GT(x, frame);
  const double text = numbersAfter(svg, "<line class=\"leader", "<text x=\"")[0];
  EXPECT_LT(text + 7.5 * 5, plot.width) << "the longest name ends inside";
}

TEST(Svg, NamesThatAreTooLongStandAbove) {
  SvgPlot plot;
  plot.width = 480;
  const std::string name(40, 'n');
  plot.series = {{name, {0, 1}, {0, 1}, {}}, {"short", {0, 1}, {1, 0}, {}}};
  const std::string svg = plot.render();
  EXPECT_EQ(svg.find("leader c"), std::string::npos);
  EXPECT_EQ(countOf(svg, "<line class=\"curve c"), 2U) << "their legend";
}

TEST(Spread, KeepsWhatIsApartAndPartsWhatIsNot) {
  EXPECT_EQ(spread({50, 10, 90}, 0, 100, 18), (std::vector<double>{50, 10, 90}));
  EXPECT_EQ(spread({50, 50, 55}, 0, 100, 18), (std::vector<double>{50, 68, 86}));
  EXPECT_EQ(spread({99, 98}, 0, 100, 18), (std::vector<double>{100, 82})) << "back from the end";
  EXPECT_EQ(spread({-5}, 0, 100, 18), (std::vector<double>{0}));
  EXPECT_TRUE(spread({}, 0, 100, 18).empty());
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
