// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "palpate/idl/types.h"
#include "palpate/report/program.h"
#include "palpate/report/text_chart.h"

namespace palpate::report {
namespace {

TEST(Flags, HaveNames) {
  EXPECT_EQ(flagNames(0), "-");
  EXPECT_EQ(flagNames(dds::flag::kInContact | dds::flag::kBeyondDomain), "contact beyond-domain");
}

TEST(Chart, TopRowHoldsOnlyThePeak) {
  std::vector<double> x, y;
  for (int i = 0; i < 100; ++i) {
    x.push_back(i);
    y.push_back(i == 50 ? 2.0 : 1.0);
  }
  const std::string chart = textChart(x, y, "s", "N", 10, 2);
  EXPECT_NE(chart.find("2 ┤     █    \n"), std::string::npos) << chart;
  EXPECT_NE(chart.find("0 ┤██████████\n"), std::string::npos) << chart;
}

TEST(Chart, OfNothingSaysSo) {
  EXPECT_EQ(textChart({}, {}, "s", "N"), "(no samples)\n");
}

TEST(TextHistogram, ShowsASingleOutlier) {
  rt::CycleStats histogram;
  for (int i = 0; i < 10000; ++i) histogram.add(100'000);
  histogram.add(9'000'000);
  const std::string text = textHistogram(histogram);
  const std::string last = text.substr(text.rfind('\n', text.size() - 2) + 1);
  EXPECT_NE(last.find(" 1 █"), std::string::npos) << text;
}

}  // namespace
}  // namespace palpate::report
