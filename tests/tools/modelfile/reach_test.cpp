// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/reach.h"

#include <gtest/gtest.h>

#include <vector>

namespace palpate::modelfile {
namespace {

/// Two triangles, the second three times as large; node 4 has no position, position 3 is a helper.
TEST(Reach, CountsTheAreaOfAccessiblePositionsThatGoSoFar) {
  const std::vector<double> X{0, 0, 0, 1, 0, 0, 0, 1, 0, -3, 0, 0, 9, 9, 9};
  const std::vector<std::int32_t> triangles{0, 1, 2, 0, 2, 3}, position{0, 1, 2, 3, -1};
  const std::vector<std::uint8_t> accessible{1, 1, 1, 0};
  const Positions positions{X, triangles, position, accessible};
  // Areas: position 0 has 1 + 3, 1 has 1, 2 has 1 + 3.
  const std::vector<double> radius{0.012, 0.02, 0.008, 0.1};
  EXPECT_DOUBLE_EQ(reachingShare(positions, radius, 0.01), 5.0 / 9.0);
  EXPECT_DOUBLE_EQ(reachingShare(positions, radius, 0.012), 5.0 / 9.0);
  EXPECT_DOUBLE_EQ(reachingShare(positions, radius, 0.001), 1.0);
  EXPECT_DOUBLE_EQ(reachingShare(positions, radius, 0.05), 0.0);
  const auto reach = reachOf(positions, radius, std::vector<double>{1.0, 1.0, 1.0, 1.0});
  EXPECT_DOUBLE_EQ(reach[0].travel, 0.007);
  EXPECT_DOUBLE_EQ(reach[0].domain, 1.0);
  EXPECT_DOUBLE_EQ(reach[2].domain, 1.0 / 9.0);
  EXPECT_DOUBLE_EQ(reach[2].series, 1.0);
  const program::Json list = reachJson(positions, radius, std::vector<double>(4, 0.01));
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[2]["travel"].get<double>(), reach[2].travel);
  EXPECT_EQ(list[2]["by_domain_radius"].get<double>(), reach[2].domain);
  EXPECT_EQ(list[1]["by_series_radius"].get<double>(), 1.0);
  EXPECT_EQ(list[2]["by_series_radius"].get<double>(), 0.0);
}

TEST(Reach, QuantilesLeaveHelpersOut) {
  const std::vector<double> radius{0.012, 0.02, 0.008, 0.1};
  const program::Json some = radiusJson(std::vector<std::uint8_t>{1, 1, 1, 0}, radius);
  EXPECT_EQ(some["min"].get<double>(), 0.008);
  EXPECT_EQ(some["median"].get<double>(), 0.012);
  EXPECT_EQ(some["max"].get<double>(), 0.02);
  EXPECT_TRUE(radiusJson(std::vector<std::uint8_t>{0, 0, 0, 0}, radius).isNull());
}

}  // namespace
}  // namespace palpate::modelfile
