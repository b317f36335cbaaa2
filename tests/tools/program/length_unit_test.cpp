// SPDX-License-Identifier: Apache-2.0
#include "tools/program/length_unit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/program/numbers.h"

namespace palpate::program {
namespace {

/// To a sphere of 50 mm around the origin, m.
double toSphere(const Point& x) {
  return std::hypot(x[0], x[1], x[2]) - 0.05;
}

std::string refusal(const AskedPlace& place) {
  try {
    checkNear(place, 0.006, toSphere);
  } catch (const ValueError& error) {
    return error.what();
  }
  return {};
}

TEST(LengthUnit, AUnitIsItsMetres) {
  EXPECT_EQ(lengthUnit("mm").metres, 1e-3);
  EXPECT_EQ(lengthUnit("cm").metres, 1e-2);
  EXPECT_EQ(lengthUnit("m").metres, 1.0);
  EXPECT_EQ(lengthUnitWords(), (std::vector<std::string>{"m", "cm", "mm"}));
  EXPECT_THROW((void)lengthUnit("inch"), ValueError);
}

TEST(LengthUnit, ALengthIsInMillimetresBelowAMetre) {
  EXPECT_EQ(lengthText(0.0004), "0.4 mm");
  EXPECT_EQ(lengthText(63.2), "63.2 m");
}

TEST(LengthUnit, AcceptsAPlaceWithinTheRadius) {
  EXPECT_EQ(refusal({"--at", {0.0, 0.0, 0.0559}}), "");
  EXPECT_EQ(refusal({"--at", {0.0, 0.0, 0.0441}}), "");
  EXPECT_EQ(refusal({"--at", {0.0, 0.0, 55.9}, lengthUnit("mm"), true}), "");
}

TEST(LengthUnit, SuspectsTheUnitInWhichAPlaceLiesOnTheOrgan) {
  EXPECT_EQ(
      refusal({"--at", {0.0, 0.0, 52.0}, lengthUnit("m"), true}),
      "--at 0,0,52 m lies 51.95 m from the organ's surface, expected at most 6 mm, the radius of the contact "
      "patch; in millimetres it would lie 2 mm from the organ's surface: --unit mm");
  EXPECT_EQ(
      refusal({"--at", {0.0, 0.0, 5.2}}),
      "--at 0,0,5.2 m lies 5.15 m from the organ's surface, expected at most 6 mm, the radius of the contact "
      "patch; in centimetres it would lie 2 mm from the organ's surface: give metres");
  EXPECT_NE(refusal({"--at", {0.0, 0.0, 0.05}, lengthUnit("mm"), true}).find("; in metres it would lie 0 mm"),
            std::string::npos);
}

TEST(LengthUnit, SuspectsNoUnitOfAPlaceThatIsOffInAll) {
  EXPECT_EQ(
      refusal({"--at", {0.0, 0.0, 0.2}, lengthUnit("m"), true}),
      "--at 0,0,0.2 m lies 150 mm from the organ's surface, expected at most 6 mm, the radius of the contact "
      "patch");
  EXPECT_EQ(refusal({"--at", {0.0, 0.0, 900.0}, lengthUnit("m"), true}).find("; in"), std::string::npos);
}

}  // namespace
}  // namespace palpate::program
