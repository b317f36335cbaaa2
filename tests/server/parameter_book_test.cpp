// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/parameter_book.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "asked.h"

namespace palpate::server {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Refusal {
  std::uint32_t field;
  double value;
  const char* message;
};

TEST(ParameterBook, SaysWhatIsInForceAtTheStart) {
  const ParameterBook book(factsOf("omni"));
  const dds::ServerParameters answer = book.answer();
  EXPECT_EQ(answer.server_id, 6U);
  EXPECT_EQ(answer.request_id, 0U);
  EXPECT_TRUE(answer.accepted);
  EXPECT_EQ(answer.revision, 0U);
  EXPECT_EQ(answer.tools[0].now.youngs_modulus, 160e3) << "the model's own is named";
  EXPECT_EQ(answer.model_youngs_modulus, 160e3);
  EXPECT_NEAR(answer.tools[0].now.coupling_stiffness, 442.1052631579, 1e-9) << "1 / (1 / 400 - 1 / 4200)";
  EXPECT_EQ(answer.tools[0].rendered_stiffness, 400.0);
  EXPECT_EQ(answer.model_stiffness, 4200.0);
}

TEST(ParameterBook, TakesWhatIsSetAndLeavesTheRest) {
  ParameterBook book(factsOf("touch"));
  const LiveParameters before = book.inForce()[0].live;
  dds::ParameterRequest both = request(dds::parameter::kFriction, 0.1);
  both.fields |= dds::parameter::kYoungsModulus;
  both.youngs_modulus = 5e4;
  const dds::ServerParameters answer = book.decide(both);
  EXPECT_TRUE(answer.accepted) << answer.message;
  EXPECT_STREQ(answer.message, "");
  EXPECT_EQ(answer.request_id, 42U);
  EXPECT_EQ(answer.revision, 1U);
  EXPECT_EQ(answer.tools[0].now.friction, 0.1);
  EXPECT_EQ(book.inForce()[0].live.youngs_modulus, 5e4);
  EXPECT_EQ(book.inForce()[0].live.coupling_stiffness, before.coupling_stiffness);
  EXPECT_EQ(book.inForce()[0].live.force_limit, before.force_limit);
}

TEST(ParameterBook, AskingAgainOrAskingOnlyChangesNothing) {
  ParameterBook book(factsOf("touch"));
  EXPECT_EQ(book.decide(request(dds::parameter::kFriction, 0.1)).revision, 1U);
  EXPECT_EQ(book.decide(request(dds::parameter::kFriction, 0.1)).revision, 1U);
  const dds::ServerParameters answer = book.decide(request(0, 0.0));
  EXPECT_TRUE(answer.accepted);
  EXPECT_EQ(answer.revision, 1U);
}

TEST(ParameterBook, RefusesWhatIsOutOfRangeByFieldNumberAndRange) {
  const Refusal refusals[] = {
      {dds::parameter::kYoungsModulus, 50.0, "youngs_modulus is 50, expected 100 to 1e+09"},
      {dds::parameter::kYoungsModulus, kInfinity, "youngs_modulus is inf"},
      {dds::parameter::kYoungsModulus, 1e9, "youngs_modulus is 1e+09, expected 100 to 160000 Pa"},
      {dds::parameter::kFriction, 0.31, "friction is 0.31, expected 0 to 0.3"},
      {dds::parameter::kCouplingDamping, 0.31, "coupling_damping is 0.31, expected 0 to 0.3 N s/m"},
      {dds::parameter::kFriction, 3.0, "friction is 3, expected 0 to 2"},
      {dds::parameter::kFriction, -0.1, "friction is -0.1"},
      {dds::parameter::kFriction, kNaN, "friction is nan"},
      {dds::parameter::kCouplingStiffness, 0.5, "coupling_stiffness is 0.5, expected 1 to"},
      {dds::parameter::kCouplingDamping, 101.0, "coupling_damping is 101, expected 0 to 100"},
      {dds::parameter::kCouplingDamping, 100.0, "coupling_damping is 100, expected at most 1.5 N s/m"},
      {dds::parameter::kForceLimit, 0.0, "force_limit is 0, expected 0.01 to 50"},
      {dds::parameter::kForceLimit, 3.4, "force_limit is 3.4, expected 0.01 to 3.3 N"},
      {dds::parameter::kForceRateLimit, 1.0, "force_rate_limit is 1, expected 10 to"},
      {64, 1.0, "fields has bits 64"},
  };
  for (const Refusal& refusal : refusals) {
    ParameterBook book(factsOf("touch"));
    const LiveParameters before = book.inForce()[0].live;
    dds::ParameterRequest asked = request(refusal.field, refusal.value);
    asked.fields |= dds::parameter::kForceRateLimit;  // a good one beside it is not taken either
    if (refusal.field != dds::parameter::kForceRateLimit) asked.force_rate_limit = 500.0;
    const dds::ServerParameters answer = book.decide(asked);
    EXPECT_FALSE(answer.accepted) << refusal.message;
    EXPECT_EQ(std::string(answer.message).find(refusal.message), 0U) << answer.message;
    EXPECT_EQ(answer.revision, 0U);
    EXPECT_EQ(answer.request_id, 42U);
    EXPECT_EQ(book.inForce()[0].live.force_rate_limit, before.force_rate_limit);
  }
}

TEST(ParameterBook, ACustomDeviceAllowsNoMoreThanItsStart) {
  Facts facts = factsOf("custom");
  facts.step.force_limit = 5.0;
  facts.step.coupling_stiffness = 2000.0;
  facts.step.force_rate_limit = 100.0;
  const Refusal refusals[] = {
      {dds::parameter::kCouplingStiffness, 2001.0, "coupling_stiffness is 2001, expected 1 to 2000 N/m"},
      {dds::parameter::kCouplingStiffness, kInfinity, "coupling_stiffness is inf, expected 1 to 2000 N/m"},
      {dds::parameter::kForceLimit, 5.1, "force_limit is 5.1, expected 0.01 to 5 N"},
      {dds::parameter::kForceLimit, kInfinity, "force_limit is inf, expected 0.01 to 5 N"},
      {dds::parameter::kForceRateLimit, 101.0, "force_rate_limit is 101, expected 10 to 100 N/s"},
      {dds::parameter::kForceRateLimit, kInfinity, "force_rate_limit is inf, expected 10 to 100 N/s"},
  };
  for (const Refusal& refusal : refusals) {
    ParameterBook book(facts);
    const dds::ServerParameters answer = book.decide(request(refusal.field, refusal.value));
    EXPECT_FALSE(answer.accepted) << refusal.message;
    EXPECT_EQ(std::string(answer.message).find(refusal.message), 0U) << answer.message;
  }
  ParameterBook book(facts);
  EXPECT_TRUE(book.decide(request(dds::parameter::kForceLimit, 1.0)).accepted);
  EXPECT_TRUE(book.decide(request(dds::parameter::kForceLimit, 5.0)).accepted) << "back to the start's";
  EXPECT_TRUE(book.decide(request(dds::parameter::kCouplingStiffness, 2000.0)).accepted);
}

TEST(ParameterBook, WhatTheOperatorSwitchedOffAClientMaySwitchOnAndOff) {
  ParameterBook book(factsOf("custom"));
  EXPECT_TRUE(book.decide(request(dds::parameter::kCouplingStiffness, 500.0)).accepted);
  EXPECT_TRUE(book.decide(request(dds::parameter::kCouplingStiffness, kInfinity)).accepted);
}

TEST(ParameterBook, TheRateLimitOfTheStartIsTheCeilingOnEveryDevice) {
  Facts facts = factsOf("touch");
  facts.step.force_rate_limit = 100.0;
  ParameterBook book(facts);
  EXPECT_TRUE(book.decide(request(dds::parameter::kForceRateLimit, 50.0)).accepted);
  EXPECT_FALSE(book.decide(request(dds::parameter::kForceRateLimit, 101.0)).accepted);
}

TEST(ParameterBook, AForceLimitBelowTheDevicesHolds) {
  Facts facts = factsOf("premium30");
  facts.step.force_limit = 2.0;
  ParameterBook book(facts);
  EXPECT_FALSE(book.decide(request(dds::parameter::kForceLimit, 22.0)).accepted);
  EXPECT_TRUE(book.decide(request(dds::parameter::kForceLimit, 1.0)).accepted);
  EXPECT_TRUE(book.decide(request(dds::parameter::kForceLimit, 2.0)).accepted) << "back to the start's";
}

TEST(ParameterBook, TheOperatorsLimitsHoldAndAreTold) {
  Facts facts = factsOf("touch");
  facts.limits.youngs_modulus = Bounds{80e3, 320e3};
  facts.limits.friction = Bounds{0.2, kInfinity};
  ParameterBook book(facts);
  const dds::ServerParameters answer = book.answer();
  EXPECT_TRUE(answer.open);
  EXPECT_EQ(answer.tools[0].lowest.youngs_modulus, 80e3);
  EXPECT_EQ(answer.tools[0].highest.youngs_modulus, 320e3);
  EXPECT_EQ(answer.tools[0].highest.force_limit, 3.3);
  EXPECT_TRUE(book.decide(request(dds::parameter::kYoungsModulus, 320e3)).accepted);
  EXPECT_FALSE(book.decide(request(dds::parameter::kYoungsModulus, 321e3)).accepted);
  EXPECT_FALSE(book.decide(request(dds::parameter::kYoungsModulus, 79e3)).accepted);
  EXPECT_TRUE(book.decide(request(dds::parameter::kYoungsModulus, 0.0)).accepted) << "the model's own";
  EXPECT_TRUE(book.decide(request(dds::parameter::kFriction, kInfinity)).accepted);
  EXPECT_FALSE(book.decide(request(dds::parameter::kFriction, 0.1)).accepted);
}

TEST(ParameterBook, RefusesAllChangesWhenParametersAreOffButSaysWhatHolds) {
  Facts facts = factsOf("touch");
  facts.parameters = false;
  ParameterBook book(facts);
  const dds::ServerParameters answer = book.decide(request(dds::parameter::kFriction, 0.1));
  EXPECT_FALSE(answer.accepted);
  EXPECT_STREQ(answer.message, "this server takes no parameters from clients");
  EXPECT_EQ(answer.tools[0].now.friction, 0.3);
  EXPECT_FALSE(answer.open);
  EXPECT_TRUE(book.decide(request(0, 0.0)).accepted) << "asking is free";
}

TEST(ParameterBook, ARequestForOneToolChangesThatToolAndEIsTheOrgans) {
  ParameterBook book(factsOf("touch"));
  dds::ParameterRequest asked = request(dds::parameter::kFriction, 0.1);
  asked.fields |= dds::parameter::kYoungsModulus;
  asked.youngs_modulus = 5e4;
  asked.tool_id = 2;
  const dds::ServerParameters answer = book.decide(asked);
  ASSERT_TRUE(answer.accepted) << answer.message;
  EXPECT_EQ(answer.tools[2].now.friction, 0.1);
  EXPECT_EQ(answer.tools[1].now.friction, 0.3);
  for (const dds::ToolParameters& tool : answer.tools) EXPECT_EQ(tool.now.youngs_modulus, 5e4);
  asked.tool_id = 4;
  EXPECT_STREQ(book.decide(asked).message, "tool_id is 4, expected 0 to 3 or 4294967295, all of them");
}

TEST(ParameterBook, ToolsWithDifferentDevicesHaveDifferentLimits) {
  Facts facts = factsOf("touch");
  ServerConfig config;
  config.own[1].device = "premium30";
  config.own[1].tip_radius = 0.004;
  settleTools(config);
  facts.step = config.step;
  facts.device[1] = "premium30";
  ParameterBook book(facts);
  const dds::ServerParameters start = book.answer();
  EXPECT_STREQ(start.tools[1].device, "premium30");
  EXPECT_EQ(start.tools[1].tip_radius, 0.004);
  EXPECT_EQ(start.tools[1].highest.force_limit, 22.0);
  EXPECT_EQ(start.tools[0].highest.force_limit, 3.3);
  dds::ParameterRequest asked = request(dds::parameter::kForceLimit, 10.0);
  const std::string message = book.decide(asked).message;
  EXPECT_EQ(message.find("force_limit is 10, expected 0.01 to 3.3 N"), 0U)
      << message << ": all tools or none";
  EXPECT_EQ(book.inForce()[1].live.force_limit, 22.0);
  asked.tool_id = 1;
  EXPECT_TRUE(book.decide(asked).accepted);
  EXPECT_NE(book.describe().find("; tool 1: device premium30, tip_radius 0.004 m"), std::string::npos);
}

TEST(ParameterBook, LimitsOfEThatLeaveOutTheModelsAreRefused) {
  Facts facts = factsOf("touch");
  facts.limits.youngs_modulus = Bounds{100.0, 5e4};
  EXPECT_THROW(ParameterBook{facts}, std::invalid_argument);
}

// An organ that is softer and less stiff than the first.
constexpr OrganStiffness kNextOrgan{20e3, 250.0};

TEST(ParameterBook, OnAnotherOrganEIsItsOwnAndAllElseStays) {
  ParameterBook book(factsOf("touch"));
  ASSERT_TRUE(book.decide(request(dds::parameter::kFriction, 0.1)).accepted);
  ASSERT_TRUE(book.decide(request(dds::parameter::kYoungsModulus, 5e4)).accepted);
  ASSERT_EQ(book.complaintAbout(kNextOrgan), "");
  book.take(kNextOrgan);
  const dds::ServerParameters answer = book.answer();
  EXPECT_EQ(answer.revision, 3U);
  EXPECT_EQ(answer.model_youngs_modulus, 20e3);
  EXPECT_EQ(answer.model_stiffness, 250.0);
  EXPECT_EQ(answer.tools[0].now.youngs_modulus, 20e3);
  EXPECT_EQ(answer.tools[0].highest.youngs_modulus, 20e3) << "nobody makes it stiffer than it is";
  EXPECT_EQ(answer.tools[0].now.friction, 0.1);
  EXPECT_EQ(answer.tools[0].highest.friction, 0.3) << "of the start";
  EXPECT_EQ(answer.tools[0].now.coupling_stiffness, kInfinity) << "a touch renders this organ as it is";
  EXPECT_FALSE(book.decide(request(dds::parameter::kYoungsModulus, 5e4)).accepted);
}

TEST(ParameterBook, OnAnotherOrganTheOperatorsEHoldsAgain) {
  Facts facts = factsOf("touch");
  facts.step.youngs_modulus = 40e3;
  ParameterBook book(facts);
  ASSERT_TRUE(book.decide(request(dds::parameter::kYoungsModulus, 1e4)).accepted);
  book.take(kNextOrgan);
  EXPECT_EQ(book.answer().tools[0].now.youngs_modulus, 40e3);
  EXPECT_EQ(book.inForceOnNext()[0].live.youngs_modulus, 40e3);
}

TEST(ParameterBook, AnOrganThatTheOperatorsLimitsLeaveOutIsRefused) {
  Facts facts = factsOf("touch");
  facts.limits.youngs_modulus = Bounds{50e3, 320e3};
  const ParameterBook book(facts);
  EXPECT_EQ(
      book.complaintAbout(kNextOrgan),
      "limits: with this model youngs_modulus is 20000, expected 50000 to 320000 Pa: what the server was "
      "started with");
}

}  // namespace
}  // namespace palpate::server
