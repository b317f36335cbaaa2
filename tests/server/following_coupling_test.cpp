// SPDX-License-Identifier: Apache-2.0
// The coupling that a device brings follows the organ, unless one was named.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "asked.h"
#include "palpate/server/live_limits.h"
#include "palpate/server/parameter_book.h"

namespace palpate::server {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ServerConfig touchWith(std::optional<double> coupling_stiffness) {
  ServerConfig config;
  config.said.coupling_stiffness = coupling_stiffness;
  settleTools(config);
  return config;
}

TEST(FollowingCoupling, ANamedOneHoldsAsItIs) {
  EXPECT_EQ(touchWith({}).step.rendered_stiffness, 300.0);
  EXPECT_EQ(toolSettings(touchWith({}).step)[3].rendered_stiffness, 300.0);
  for (const double named : {100.0, 350.0}) {
    const ServerConfig config = touchWith(named);
    EXPECT_FALSE(deviceComplaint(config).has_value());
    for (const ToolSettings& tool : toolSettings(config.step))
      EXPECT_NEAR(asFelt(tool, {160e3, 4200.0}).coupling_stiffness, named, 1e-9);
  }
  EXPECT_TRUE(deviceComplaint(touchWith(kInfinity)).has_value()) << "none at all, however stiff the organ is";
  EXPECT_TRUE(std::isinf(withDevice({}, "custom", {}).rendered_stiffness));
}

TEST(FollowingCoupling, LimitsHoldTheStartsInfinity) {
  ServerConfig config = touchWith({});
  config.limits.coupling_stiffness = Bounds{1.0, 300.0};
  EXPECT_EQ(limitsComplaint(config)->text, "is 1 to 300 N/m, which leaves out the start's inf");
  config.limits.coupling_stiffness->high = kInfinity;
  EXPECT_FALSE(limitsComplaint(config).has_value());
  config = touchWith(300.0);
  config.limits.coupling_stiffness = Bounds{1.0, 401.0};
  EXPECT_EQ(limitsComplaint(config)->text, "is 1 to 401 N/m, expected a range within 1 to 400 N/m");
}

TEST(FollowingCoupling, FollowsEAndWhatIsAskedForIsNeverStiffer) {
  ParameterBook book(factsOf("touch"));
  const auto K = [&] { return book.answer().tools[0].now.coupling_stiffness; };
  EXPECT_NEAR(K(), 323.0769230769, 1e-9);
  EXPECT_NE(book.describe().find("coupling_stiffness 323.077 N/m (with the organ at most 300 N/m)"),
            std::string::npos)
      << book.describe();
  EXPECT_TRUE(book.decide(request(dds::parameter::kYoungsModulus, 5e3)).accepted);
  EXPECT_TRUE(std::isinf(K())) << "131 N/m";
  EXPECT_TRUE(book.decide(request(dds::parameter::kCouplingStiffness, 350.0)).accepted);
  EXPECT_NEAR(K(), 350.0, 1e-9);
  EXPECT_TRUE(book.decide(request(dds::parameter::kYoungsModulus, 160e3)).accepted);
  EXPECT_NEAR(K(), 323.0769230769, 1e-9);
  EXPECT_TRUE(book.decide(request(dds::parameter::kCouplingStiffness, 100.0)).accepted);
  EXPECT_NEAR(K(), 100.0, 1e-9);
  EXPECT_TRUE(book.decide(request(dds::parameter::kCouplingStiffness, kInfinity)).accepted) << "back";
  EXPECT_NEAR(K(), 323.0769230769, 1e-9);
}

TEST(FollowingCoupling, FollowsTheDeviceThatADriverNames) {
  for (const char* const start : {"custom", "omni"}) {
    ParameterBook book(factsOf(start));
    dds::ToolAnnouncement said{};
    dds::assignText(said.device, "touch");
    EXPECT_TRUE(book.announced(0, DriverWord{1, {}, said}));
    EXPECT_EQ(book.refusal(0), "");
    EXPECT_EQ(book.inForce()[0].rendered_stiffness, 300.0) << start;
    EXPECT_EQ(book.inForce()[1].rendered_stiffness, factsOf(start).step.rendered_stiffness);
    EXPECT_NEAR(book.answer().tools[0].now.coupling_stiffness, 323.0769230769, 1e-9);
  }
}

}  // namespace
}  // namespace palpate::server
