// SPDX-License-Identifier: Apache-2.0
// What a driver's announcement may change.
#include <gtest/gtest.h>

#include <limits>

#include "asked.h"
#include "palpate/server/parameter_book.h"

namespace palpate::server {
namespace {

// What a driver says first.
DriverWord wordOf(const dds::ToolAnnouncement& what) {
  return {1, {}, what};
}

TEST(ParameterBook, WhereParametersAreOffADriverOnlyLowersToItsDevice) {
  Facts facts = factsOf("touch");
  facts.parameters = false;
  ParameterBook book(facts);
  dds::ToolAnnouncement said{};
  said.device_force_limit = 1.0;
  said.fields = dds::parameter::kFriction;
  said.values.friction = 0.1;
  said.has_tip_radius = true;
  said.tip_radius = 0.004;
  EXPECT_TRUE(book.announced(0, wordOf(said)));
  EXPECT_EQ(book.refusal(0), "");
  EXPECT_EQ(book.inForce()[0].live.force_limit, 1.0);
  EXPECT_EQ(book.inForce()[0].live.friction, 0.3);
  EXPECT_EQ(book.inForce()[0].tip_radius, facts.step.tip_radius);
}

TEST(ParameterBook, ADriversTipIsHalfToTwiceTheOperators) {
  for (const double ratio : {0.49, 0.5, 2.0, 2.1, std::nan("")}) {
    const Facts facts = factsOf("touch");
    ParameterBook book(facts);
    dds::ToolAnnouncement said{};
    said.has_tip_radius = true;
    said.tip_radius = ratio * facts.step.tip_radius;
    EXPECT_TRUE(book.announced(0, wordOf(said)));
    const bool near = ratio >= 0.5 && ratio <= 2.0;
    EXPECT_EQ(book.refusal(0).empty(), near) << ratio << ": " << book.refusal(0);
    EXPECT_EQ(book.inForce()[0].tip_radius, near ? said.tip_radius : facts.step.tip_radius);
  }
}

TEST(ParameterBook, ADriversTipIsWithinWhatTheOperatorAllows) {
  for (const double radius : {0.0049, 0.005, 0.006, 0.0061}) {
    Facts facts = factsOf("touch");
    facts.tip_limits = Bounds{0.005, 0.006};
    ParameterBook book(facts);
    dds::ToolAnnouncement said{};
    said.has_tip_radius = true;
    said.tip_radius = radius;
    EXPECT_TRUE(book.announced(0, wordOf(said)));
    EXPECT_EQ(book.refusal(0).empty(), radius >= 0.005 && radius <= 0.006) << book.refusal(0);
  }
}

TEST(ParameterBook, ADeviceWeakerThanTheOperatorsLowestStillHolds) {
  Facts facts = factsOf("touch");
  facts.limits.force_limit = Bounds{2.0, 3.3};
  ParameterBook book(facts);
  dds::ToolAnnouncement said{};
  said.device_force_limit = 0.5;
  EXPECT_TRUE(book.announced(0, wordOf(said)));
  EXPECT_EQ(book.refusal(0), "");
  EXPECT_EQ(book.inForce()[0].live.force_limit, 0.5);
  EXPECT_EQ(book.answer().tools[0].lowest.force_limit, 0.5);
}

}  // namespace
}  // namespace palpate::server
