// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "palpate/client/error.h"
#include "palpate/idl/types.h"
#include "palpate/report/program.h"
#include "palpate/report/text_chart.h"

namespace palpate::report {
namespace {

std::string refusal(const std::string& text) {
  try {
    (void)parsePoint("--at", text);
  } catch (const client::ClientError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Point, IsReadFromThreeNumbers) {
  EXPECT_EQ(parsePoint("--at", "0.1,-2e-3,3"), (client::Point{0.1, -2e-3, 3.0}));
}

TEST(Point, RejectsAnythingElse) {
  for (const char* text :
       {"", "1", "1,2", "1,2,", "1,2,3,4", "1,2,x", "1,2,nan", "1,inf,3", "1;2;3", "1,2,3 "})
    EXPECT_EQ(refusal(text), "--at is '" + std::string(text) + "', expected three finite numbers x,y,z");
}

TEST(Flags, HaveNames) {
  EXPECT_EQ(flagNames(0), "-");
  EXPECT_EQ(flagNames(dds::flag::kInContact | dds::flag::kBeyondDomain), "contact beyond-domain");
}

TEST(File, IsWrittenWholeOrNotAtAll) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("palpate-report-" + std::to_string(getpid()));
  writeFile(path, "hello");
  std::ifstream file(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "hello");
  std::filesystem::remove(path);
  try {
    writeFile("/nonexistent/plot.svg", "x");
    FAIL() << "wrote into a folder that does not exist";
  } catch (const client::ClientError& error) {
    EXPECT_STREQ(error.what(), "cannot write /nonexistent/plot.svg: No such file or directory");
  }
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
