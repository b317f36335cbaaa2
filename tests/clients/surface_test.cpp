// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "palpate/client/error.h"
#include "palpate/client/place.h"
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
  source.addRegions();
  const Surface surface = checkedSurface(source.message());
  ASSERT_EQ(surface.positions.size(), 5U);
  ASSERT_EQ(surface.triangles.size(), 6U);
  EXPECT_EQ(surface.positions[2], (device::Point{0.1, 0.1, 0}));
  EXPECT_EQ(surface.triangles[5], (std::array<std::uint32_t, 3>{3, 0, 4}));
  EXPECT_EQ(surface.mesh_tags[4], 15);
  EXPECT_EQ(surface.model_id, source.model_id);
  EXPECT_EQ(surface.clamped, source.clamped);
  ASSERT_EQ(surface.regions.size(), 2U);
  EXPECT_EQ(surface.regions[0].name, "elsewhere");
  EXPECT_TRUE(surface.regions[0].triangles.empty());
  EXPECT_EQ(surface.regions[1].youngs_modulus, 70e3);
  EXPECT_EQ(surface.regions[1].positions[2], (device::Point{0.05, 0.06, 0.02}));
  EXPECT_EQ(surface.regions[1].triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(Surface, OfAnOlderServerThatDoesNotSayWhatIsClampedNothingIs) {
  SmallSurface source;
  source.clamped.clear();
  EXPECT_EQ(checkedSurface(source.message()).clamped, std::vector<std::uint8_t>(5, 0));
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
  SmallSurface clamp;
  clamp.clamped.pop_back();
  EXPECT_EQ(refusal(clamp), "surface from the server: clamped has 4 entries, expected 5");
  SmallSurface id;
  id.model_id = "a\nb";
  EXPECT_EQ(refusal(id), "surface from the server: model_id holds an unprintable character");
}

TEST(Surface, RejectsRegionsThatAServerMustNotSend) {
  const auto refused = [](auto spoil) {
    SmallSurface surface;
    spoil(surface);
    surface.addRegions();
    return refusal(surface);
  };
  EXPECT_EQ(refused([](SmallSurface& s) { s.region_triangles[1] = 3; }),
            "surface from the server: region 1: triangle 0 names node 3 of 3");
  EXPECT_EQ(refused([](SmallSurface& s) { s.region_positions[4] = std::numeric_limits<double>::infinity(); }),
            "surface from the server: region 1: position of node 1 is not finite");
  EXPECT_EQ(refused([](SmallSurface& s) { s.region_positions.pop_back(); }),
            "surface from the server: region 1: positions has 8 entries, expected 3 for each node");
  EXPECT_EQ(refused([](SmallSurface& s) { s.region_triangles.push_back(0); }),
            "surface from the server: region 1: triangles has 4 entries, expected 3 for each triangle");
  SmallSurface soft;
  soft.addRegions();
  soft.regions[0].youngs_modulus = 0.0;
  EXPECT_EQ(refusal(soft),
            "surface from the server: region 0: youngs_modulus is 0.000000 Pa, expected more than 0");
}

TEST(Surface, KeepsWhatTheServerSaysOfTheModel) {
  SmallSurface source;
  EXPECT_EQ(checkedSurface(source.message()).contact_radius, 0.006);
  EXPECT_EQ(checkedSurface(source.message()).certificate, "not certified: it is a pyramid");
  source.certificate = std::string(600, 'x');
  EXPECT_EQ(checkedSurface(source.message()).certificate.size(), 511U) << "bounded on the wire";
  source.certificate = "\x1b[31m";
  EXPECT_EQ(refusal(source), "surface from the server: certificate holds an unprintable character");
  SmallSurface negative;
  negative.contact_radius = -1.0;
  EXPECT_EQ(refusal(negative), "surface from the server: contact_radius is -1.000000 m, expected 0 or more");
  negative.contact_radius = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(negative), "surface from the server: contact_radius is inf m, expected 0 or more");
}

TEST(Place, DistanceIsToTheNearestTriangle) {
  SmallSurface source;
  const Surface surface = checkedSurface(source.message());
  EXPECT_NEAR(distanceTo(surface, {0.05, 0.05, -0.01}), 0.01, 1e-15);  // below the square's middle
  EXPECT_NEAR(distanceTo(surface, {0.05, 0.05, 0.08}), 0.03, 1e-15);   // above the apex
  EXPECT_NEAR(distanceTo(surface, {-0.02, 0.05, 0.0}), 0.02, 1e-15);   // beside an edge
  EXPECT_NEAR(distanceTo(surface, {0.05, 0.02, 0.04}), 0.01 * std::sqrt(2.0),
              1e-15);  // off a side, which rises by 45 degrees
  EXPECT_NEAR(distanceTo(surface, {9.0, 9.0, 9.0}), length(device::Point{8.9, 8.9, 9.0}), 1e-12);
  EXPECT_EQ(distanceTo(surface, surface.positions[2]), 0.0);
}

TEST(Place, ThePathsNearestPointIsFoundAlsoWhereItIsBrief) {
  SmallSurface source;
  const Surface surface = checkedSurface(source.message());
  const auto itself = [](const device::Point& x) { return x; };
  std::vector<device::Point> path;
  EXPECT_EQ(nearestOf(surface, path, itself), std::numeric_limits<double>::infinity());
  for (int i = 0; i < 995; ++i)
    path.push_back({0.05, 0.05, 0.15 - 9.5e-5 * i});  // down to 5.57 mm above the apex
  const double reached = path.back()[2] - 0.05;
  EXPECT_GE(nearestOf(surface, path, itself), reached - 1e-12);
  EXPECT_LE(nearestOf(surface, path, itself), reached + 1e-4);
  path.resize(10);
  path.push_back({0.05, 0.05, 0.06});  // for one pose only
  path.push_back({0.05, 0.05, 0.15});
  EXPECT_NEAR(nearestOf(surface, path, itself), 0.01, 1e-12);
}

TEST(Place, RadiusOfAnOlderServerThatDoesNotSayItIsTheMeanEdge) {
  SmallSurface source;
  EXPECT_EQ(contactRadius(checkedSurface(source.message())), 0.006);
  source.contact_radius = 0.0;
  const double base = 0.1, diagonal = 0.1 * std::sqrt(2.0), side = std::sqrt(3.0) * 0.05;
  EXPECT_NEAR(contactRadius(checkedSurface(source.message())), (8 * base + 2 * diagonal + 8 * side) / 18,
              1e-15);
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
