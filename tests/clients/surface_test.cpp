// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "palpate/client/error.h"
#include "small_surface.h"

namespace palpate::client {
namespace {

using palpate::testing::SmallSurface;

std::string refusal(SmallSurface& surface) {
  try {
    (void)checkedSurface(surface.message());
  } catch (const ClientError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Surface, IsCopiedUnchanged) {
  SmallSurface source;
  const Surface surface = checkedSurface(source.message());
  ASSERT_EQ(surface.positions.size(), 5U);
  ASSERT_EQ(surface.triangles.size(), 6U);
  EXPECT_EQ(surface.positions[2], (device::Point{0.1, 0.1, 0}));
  EXPECT_EQ(surface.triangles[5], (std::array<std::uint32_t, 3>{3, 0, 4}));
  EXPECT_EQ(surface.mesh_tags[4], 15);
  EXPECT_EQ(surface.model_id, source.model_id);
}

TEST(Surface, RejectsWhatAServerMustNotSend) {
  SmallSurface index;
  index.triangles[4] = 5;
  EXPECT_EQ(refusal(index), "surface from the server: triangle 1 names node 5 of 5");
  SmallSurface nan;
  nan.positions[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(nan), "surface from the server: position of node 2 is not finite");
  SmallSurface odd;
  odd.positions.pop_back();
  EXPECT_EQ(refusal(odd), "surface from the server: positions has 14 entries, expected 3 for each node");
  SmallSurface none;
  none.triangles.clear();
  EXPECT_EQ(refusal(none), "surface from the server: triangles has 0 entries, expected 3 for each triangle");
  SmallSurface mask;
  mask.accessible.pop_back();
  EXPECT_EQ(refusal(mask), "surface from the server: accessible has 4 entries, expected 5");
  SmallSurface tags;
  tags.mesh_tags.push_back(1);
  EXPECT_EQ(refusal(tags), "surface from the server: mesh_tags has 6 entries, expected 5");
  SmallSurface id;
  id.model_id = "a\nb";
  EXPECT_EQ(refusal(id), "surface from the server: model_id holds an unprintable character");
}

TEST(Spot, DefaultIsTheHighestNodeWithItsOutwardNormal) {
  SmallSurface source;
  const Spot spot = chooseSpot(checkedSurface(source.message()), std::nullopt);
  EXPECT_EQ(spot.node, 4U);
  EXPECT_EQ(spot.mesh_tag, 15);
  EXPECT_NEAR(length(spot.normal - device::Point{0, 0, 1}), 0.0, 1e-12);
}

TEST(Spot, IsTheNearestAccessibleNode) {
  SmallSurface source;
  const Surface surface = checkedSurface(source.message());
  EXPECT_EQ(chooseSpot(surface, device::Point{0.2, 0.2, 0.0}).node, 2U);
  // Node 0 lies there but is not accessible, and its neighbours touch it: those come last.
  EXPECT_NE(chooseSpot(surface, device::Point{0, 0, 0}).node, 0U);
}

TEST(Spot, RejectsASurfaceThatNobodyMayTouch) {
  SmallSurface source;
  source.accessible.assign(5, 0);
  try {
    (void)chooseSpot(checkedSurface(source.message()), std::nullopt);
    FAIL() << "accepted";
  } catch (const ClientError& error) {
    EXPECT_STREQ(error.what(), "no node of the organ's surface is accessible");
  }
}

}  // namespace
}  // namespace palpate::client
