// SPDX-License-Identifier: Apache-2.0
// That another reader finds the same quantiles: hdr_log_test.mjs.
#include "hdr_log.h"

#include <gtest/gtest.h>

#include <sstream>

namespace palpate::latency {
namespace {

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(HdrLog, HasALineForEachDistributionWithValues) {
  rt::CycleStats force, tick, none;
  force.add(812'345);
  force.add(100'000);
  tick.add(7'000);
  const auto lines = linesOf(hdrLogOf({{"pose_to_force", &force}, {"pose_to_field", &none}, {"tick", &tick}},
                                      {1'441'812'279'474, 2.5}));
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[1], "#[Histogram log format version 1.3]");
  EXPECT_EQ(lines[2], "#[StartTime: 1441812279.474 (seconds since epoch), Wed Sep 09 15:24:39 UTC 2015]");
  EXPECT_EQ(lines[4],
            "\"StartTimestamp\",\"Interval_Length\",\"Interval_Max\",\"Interval_Compressed_Histogram\"");
  EXPECT_EQ(lines[5].rfind("Tag=pose_to_force,0.000,2.500,0.812345,HISTFA", 0), 0U) << lines[5];
  EXPECT_EQ(lines[6].rfind("Tag=tick,0.000,2.500,0.007000,HISTFA", 0), 0U) << lines[6];
}

}  // namespace
}  // namespace palpate::latency
