// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/report.h"

#include <gtest/gtest.h>

#include "tools/examine/reproduce/fill.h"

namespace palpate::reproduce {
namespace {

TEST(Fill, PutsEveryLeafUnderItsPath) {
  const Json results{{"pairs", 167},
                     {"order", {{"ten_term", 1.998}}},
                     {"rows", std::vector<Json>{{{"x", 2.5}}, {{"x", 3.5}}}}};
  EXPECT_EQ(fill("{pairs:.0f} pairs, order {order_ten_term:.2f}, {rows_1_x:g}", results),
            "167 pairs, order 2.00, 3.5");
}

TEST(Fill, GivesPercent) {
  EXPECT_EQ(fill("{pct_error:+.1f} %", Json{{"error", -0.095}}), "-9.5 %");
}

TEST(Fill, TakesWordsAsTheyAre) {
  EXPECT_EQ(fill("on {machine}", Json{{"machine", "a machine {x}"}}), "on a machine {x}");
}

TEST(Fill, RefusesAResultThatIsNotThere) {
  EXPECT_THROW((void)fill("{error:.1f}", Json{{"errors", 1.0}}), ReproduceError);
}

TEST(Fill, RefusesAMissingNumber) {
  // NaN becomes null in a JSON file; a report must not print what was not computed.
  EXPECT_THROW((void)fill("{error:.1f}", Json{{"error", nullptr}}), ReproduceError);
}

TEST(Table, HasALineForEveryRow) {
  const Json rows = std::vector<Json>{{{"pairs", 20}, {"error", 0.5}}, {{"pairs", 50}}};
  EXPECT_EQ(table(rows, {{"n", "pairs", "{:.0f}"}, {"error, %", "error", "{:.1f}", 100.0}}),
            "| n | error, % |\n|---|---|\n| 20 | 50.0 |\n| 50 | - |\n");
}

TEST(Report, HoldsTheChaptersThatWereRunOnly) {
  const Json results{{"run", {{"version", "1"}, {"date", "today"}, {"machine", "this"}}}};
  const std::string text = report(results, false);
  EXPECT_NE(text.find("Where the paper is wrong or silent"), std::string::npos);
  EXPECT_EQ(text.find("## 1. The rod"), std::string::npos);
}

}  // namespace
}  // namespace palpate::reproduce
