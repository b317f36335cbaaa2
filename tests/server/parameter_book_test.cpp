// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/parameter_book.h"

#include <gtest/gtest.h>

#include <limits>

#include "palpate/server/config.h"

namespace palpate::server {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Facts factsOf(const std::string& device) {
  Facts facts;
  facts.server_id = 6;
  facts.device = device;
  facts.step = withDevice({}, device, {});
  facts.youngs_modulus = 160e3;
  return facts;
}

// A request for one field.
dds::ParameterRequest request(std::uint32_t field, double value) {
  dds::ParameterRequest asked{};
  asked.request_id = 42;
  asked.fields = field;
  for (double* number : {&asked.youngs_modulus, &asked.friction, &asked.coupling_stiffness,
                         &asked.coupling_damping, &asked.force_limit, &asked.force_rate_limit})
    *number = kNaN;  // what is not set is not looked at
  switch (field) {
    case dds::parameter::kYoungsModulus:
      asked.youngs_modulus = value;
      break;
    case dds::parameter::kFriction:
      asked.friction = value;
      break;
    case dds::parameter::kCouplingStiffness:
      asked.coupling_stiffness = value;
      break;
    case dds::parameter::kCouplingDamping:
      asked.coupling_damping = value;
      break;
    case dds::parameter::kForceLimit:
      asked.force_limit = value;
      break;
    default:
      asked.force_rate_limit = value;
  }
  return asked;
}

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
  EXPECT_EQ(answer.youngs_modulus, 160e3) << "the model's own is named";
  EXPECT_EQ(answer.model_youngs_modulus, 160e3);
  EXPECT_EQ(answer.coupling_stiffness, findDevicePreset("omni")->coupling_stiffness);
}

TEST(ParameterBook, TakesWhatIsSetAndLeavesTheRest) {
  ParameterBook book(factsOf("touch"));
  const LiveParameters before = book.inForce();
  dds::ParameterRequest both = request(dds::parameter::kFriction, 0.1);
  both.fields |= dds::parameter::kYoungsModulus;
  both.youngs_modulus = 5e4;
  const dds::ServerParameters answer = book.decide(both);
  EXPECT_TRUE(answer.accepted) << answer.message;
  EXPECT_STREQ(answer.message, "");
  EXPECT_EQ(answer.request_id, 42U);
  EXPECT_EQ(answer.revision, 1U);
  EXPECT_EQ(answer.friction, 0.1);
  EXPECT_EQ(book.inForce().youngs_modulus, 5e4);
  EXPECT_EQ(book.inForce().coupling_stiffness, before.coupling_stiffness);
  EXPECT_EQ(book.inForce().force_limit, before.force_limit);
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
      {dds::parameter::kFriction, 3.0, "friction is 3, expected 0 to 2"},
      {dds::parameter::kFriction, -0.1, "friction is -0.1"},
      {dds::parameter::kFriction, kNaN, "friction is nan"},
      {dds::parameter::kCouplingStiffness, 0.5, "coupling_stiffness is 0.5, expected 1 to"},
      {dds::parameter::kCouplingStiffness, 401.0, "coupling_stiffness is 401, expected at most 400 N/m"},
      {dds::parameter::kCouplingStiffness, kInfinity, "coupling_stiffness is inf, expected at most 400 N/m"},
      {dds::parameter::kCouplingDamping, 101.0, "coupling_damping is 101, expected 0 to 100"},
      {dds::parameter::kCouplingDamping, 100.0, "coupling_damping is 100, expected at most 1.5 N s/m"},
      {dds::parameter::kForceLimit, 0.0, "force_limit is 0, expected 0.01 to 50"},
      {dds::parameter::kForceLimit, 3.4, "force_limit is 3.4, expected at most 3.3 N"},
      {dds::parameter::kForceRateLimit, 1.0, "force_rate_limit is 1, expected 10 to"},
      {64, 1.0, "fields has bits 64"},
  };
  for (const Refusal& refusal : refusals) {
    ParameterBook book(factsOf("touch"));
    const LiveParameters before = book.inForce();
    dds::ParameterRequest asked = request(refusal.field, refusal.value);
    asked.fields |= dds::parameter::kForceRateLimit;  // a good one beside it is not taken either
    if (refusal.field != dds::parameter::kForceRateLimit) asked.force_rate_limit = 500.0;
    const dds::ServerParameters answer = book.decide(asked);
    EXPECT_FALSE(answer.accepted) << refusal.message;
    EXPECT_EQ(std::string(answer.message).find(refusal.message), 0U) << answer.message;
    EXPECT_EQ(answer.revision, 0U);
    EXPECT_EQ(answer.request_id, 42U);
    EXPECT_EQ(book.inForce().force_rate_limit, before.force_rate_limit);
  }
}

TEST(ParameterBook, ACustomDeviceAllowsNoMoreThanItsStart) {
  Facts facts = factsOf("custom");
  facts.step.force_limit = 5.0;
  facts.step.coupling_stiffness = 2000.0;
  facts.step.force_rate_limit = 100.0;
  const Refusal refusals[] = {
      {dds::parameter::kCouplingStiffness, 2001.0, "coupling_stiffness is 2001, expected at most 2000 N/m"},
      {dds::parameter::kCouplingStiffness, kInfinity, "coupling_stiffness is inf, expected at most 2000 N/m"},
      {dds::parameter::kForceLimit, 5.1, "force_limit is 5.1, expected at most 5 N"},
      {dds::parameter::kForceLimit, kInfinity, "force_limit is inf, expected at most 5 N"},
      {dds::parameter::kForceRateLimit, 101.0, "force_rate_limit is 101, expected at most 100 N/s"},
      {dds::parameter::kForceRateLimit, kInfinity, "force_rate_limit is inf, expected at most 100 N/s"},
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

}  // namespace
}  // namespace palpate::server
