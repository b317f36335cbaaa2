// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "assertion.h"
#include "latency_report.h"
#include "palpate/testing/xml_fault.h"
#include "tools/program/numbers.h"

namespace palpate::latency {
namespace {

using program::Json;

Json shape() {
  return jsonOf(LatencyLog(1), {}, {});
}

Json report() {
  return {{"pose_to_force_us", {{"p99", 812.5}, {"count", 1000}}},
          {"pose_to_field_us", {{"p99", 0.0}, {"count", 0}}},
          {"lost", 0},
          {"server_realtime", true}};
}

bool holds(const std::string& text) {
  return judge(parseAssertion(text, shape()), report()).held;
}

std::string refusal(const std::string& text) {
  try {
    (void)parseAssertion(text, shape());
  } catch (const program::ValueError& error) {
    return error.what();
  }
  return "";
}

TEST(Assertion, EachRelationIsJudged) {
  EXPECT_FALSE(holds("pose_to_force_us.p99<812.5"));
  EXPECT_TRUE(holds("pose_to_force_us.p99<=812.5"));
  EXPECT_TRUE(holds("pose_to_force_us.p99 < 813"));
  EXPECT_TRUE(holds(" pose_to_force_us.p99 >= 8.125e2 "));
  EXPECT_FALSE(holds("pose_to_force_us.p99>812.5"));
  EXPECT_TRUE(holds("lost==0"));
  EXPECT_FALSE(holds("lost!=0"));
  EXPECT_TRUE(holds("server_realtime==true"));
  EXPECT_FALSE(holds("server_realtime==false"));
}

TEST(Assertion, WhatWasNotMeasuredHoldsNothing) {
  EXPECT_FALSE(holds("pose_to_field_us.p99<500"));
  EXPECT_TRUE(holds("pose_to_field_us.count==0"));
  const Outcome outcome = judge(parseAssertion("pose_to_field_us.p99<500", shape()), report());
  EXPECT_EQ(failureLine(outcome), "assertion failed: pose_to_field_us.p99<500: it is not measured");
}

TEST(Assertion, AFailureNamesTheFigureFound) {
  const Outcome outcome = judge(parseAssertion("pose_to_force_us.p99<500", shape()), report());
  EXPECT_EQ(failureLine(outcome), "assertion failed: pose_to_force_us.p99<500: it is 812.5");
}

TEST(Assertion, OfSeveralToolsEachIsJudgedAndTheFirstThatFailsNamed) {
  Json first = report(), second = report();
  first["tool_id"] = 1;
  second["tool_id"] = 2;
  second["lost"] = 7;
  const auto judged = [&](const std::string& text) {
    return judgeEach(parseAssertion(text, shape()), {first, second});
  };
  EXPECT_TRUE(judged("pose_to_force_us.p99<900").held);
  EXPECT_TRUE(judged("lost<8").held);
  EXPECT_EQ(failureLine(judged("lost==0")), "assertion failed: lost==0: it is 7 of tool 2");
  EXPECT_FALSE(judged("lost>=1").held) << "for tool 1 it does not hold";
}

TEST(LatencyReport, OfSeveralToolsTheWorstFiguresCount) {
  Json first{{"tool_id", 0},
             {"tick_us", {{"p99", 3.0}, {"count", 9}}},
             {"lost", 1},
             {"sent", 10},
             {"client_realtime", true},
             {"model_id", "m"}};
  Json second{{"tool_id", 1},
              {"tick_us", {{"p99", 5.0}, {"count", 7}}},
              {"lost", 0},
              {"sent", 11},
              {"client_realtime", false},
              {"model_id", "m"}};
  const Json worst = worstOf({first, second});
  EXPECT_EQ(worst["tick_us"], (Json{{"p99", 5.0}, {"count", 7}}));
  EXPECT_EQ(worst["lost"], Json(1));
  EXPECT_EQ(worst["sent"], Json(10));
  EXPECT_EQ(worst["client_realtime"], Json(false));
  EXPECT_EQ(worst["model_id"], Json("m"));
  EXPECT_FALSE(worst.contains("tool_id"));
  ASSERT_EQ(worst["tools"].size(), 2U);
  EXPECT_EQ(worst["tools"][1], second);
}

TEST(Assertion, WhatDoesNotReadIsRefusedWithWhatWould) {
  EXPECT_NE(refusal("lost").find("< <= == != >= >"), std::string::npos);
  EXPECT_NE(refusal("lost=0").find("< <= == != >= >"), std::string::npos);
  EXPECT_NE(refusal("lost==few").find("'few' is not a number"), std::string::npos);
  EXPECT_NE(refusal("lost==0x").find("'0x' is not a number"), std::string::npos);
  EXPECT_NE(refusal("lost<nan").find("'nan' is not a number"), std::string::npos);
  EXPECT_NE(refusal("lots==0").find("no figure 'lots'; there are "), std::string::npos);
  EXPECT_NE(refusal("lots==0").find("lost"), std::string::npos);
  EXPECT_NE(refusal("tick_us.p95<9").find("tick_us.p99, "), std::string::npos) << refusal("tick_us.p95<9");
  EXPECT_NE(refusal("tick_us<9").find("tick_us.p50"), std::string::npos) << refusal("tick_us<9");
  EXPECT_NE(refusal("model_id==1").find("no figure 'model_id'"), std::string::npos) << "a text has no bounds";
}

TEST(Assertion, JUnitHasACaseForEach) {
  const std::string xml = junitOf({judge(parseAssertion("pose_to_force_us.p99<500", shape()), report()),
                                   judge(parseAssertion("lost==0", shape()), report())},
                                  2.0);
  EXPECT_EQ(testing::xmlFault(xml), "") << xml;
  EXPECT_NE(xml.find("tests=\"2\" failures=\"1\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("<failure message=\"assertion failed: pose_to_force_us.p99&lt;500: it is 812.5\"/>"),
            std::string::npos)
      << xml;
}

}  // namespace
}  // namespace palpate::latency
