// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "palpate/client/error.h"
#include "small_surface.h"
#include "tools.h"

namespace palpate::latency {
namespace {

client::Surface pyramid() {
  testing::SmallSurface surface;
  return client::checkedSurface(surface.message());
}

TEST(SpotsApart, EachToolGetsANodeOfItsOwnFarFromTheOthers) {
  const client::Surface surface = pyramid();
  const client::Spot apex = client::chooseSpot(surface, {});
  const auto spots = spotsApart(surface, apex, 4);
  ASSERT_EQ(spots.size(), 4U);
  EXPECT_EQ(spots[0].node, apex.node);
  std::set<std::uint32_t> nodes;
  for (const auto& spot : spots) {
    nodes.insert(spot.node);
    EXPECT_NE(surface.accessible[spot.node], 0);
  }
  EXPECT_EQ(nodes.size(), 4U);
}

TEST(SpotsApart, FewerPlacesThanToolsAreRefused) {
  client::Surface surface = pyramid();
  surface.accessible = {0, 0, 0, 1, 1};
  const client::Spot apex = client::chooseSpot(surface, {});
  EXPECT_EQ(spotsApart(surface, apex, 2).size(), 2U);
  EXPECT_THROW((void)spotsApart(surface, apex, 3), client::ClientError);
}

}  // namespace
}  // namespace palpate::latency
