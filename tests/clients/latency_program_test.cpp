// SPDX-License-Identifier: Apache-2.0
// palpate-latency as a process, against a small server inside the test.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "fake_server.h"
#include "on_domain.h"
#include "palpate/testing/child_process.h"
#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"
#include "palpate/testing/test_domain.h"
#include "palpate/testing/xml_fault.h"

namespace palpate::testing {
namespace {

using nlohmann::json;

TEST(Latency, AnAssertionThatAStallBreaksFailsWithOneLineAndCode3) {
  const FakeServer server(exclusiveDomain(), {.stall_every = 400});  // 40 ms each
  const TemporaryFile junit("latency.xml");
  const auto result =
      runProgram("palpate-latency", onDomain({"--seconds", "1.5", "--assert", "pose_to_force_us.max<30000",
                                              "--assert", "received > 100", "--junit", junit.path()}));
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.err.find("palpate-latency: assertion failed: pose_to_force_us.max<30000: it is "),
            std::string::npos)
      << result.err;
  EXPECT_EQ(result.err.find("received"), std::string::npos) << "what holds is not told: " << result.err;
  EXPECT_EQ(xmlFault(contentOf(junit.path())), "");
  EXPECT_NE(contentOf(junit.path()).find("failures=\"1\""), std::string::npos);
}

TEST(Latency, AMeasurementThatTheServerLeavesHoldsNoAssertion) {
  const FakeServer server(exclusiveDomain(), {.leave_after = 1});
  const TemporaryFile junit("left.xml");
  const auto result =
      runProgram("palpate-latency",
                 onDomain({"--seconds", "1", "--json", "--assert", "lost==0", "--junit", junit.path()}));
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_TRUE(json::parse(result.out)["server_left"]);
  EXPECT_NE(result.err.find("assertion failed: lost==0: it is not measured to the end"), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("the server left before the end"), std::string::npos) << result.err;
  EXPECT_NE(contentOf(junit.path()).find("failures=\"1\""), std::string::npos);
}

TEST(Latency, AMeasurementThatIsInterruptedHoldsNoAssertion) {
  const FakeServer server(exclusiveDomain(), {});
  std::string said;
  for (int seconds = 2;
       seconds < 60 && said.find("lost>=0: it is not measured to the end") == std::string::npos;
       seconds *= 2) {  // a busy machine takes longer to begin
    const CaughtOutput caught;
    ChildProcess measured("palpate-latency", onDomain({"--seconds", "600", "--assert", "lost>=0"}),
                          {caught.descriptor(), caught.descriptor()});
    std::this_thread::sleep_for(std::chrono::seconds(seconds));
    measured.signal(SIGINT);
    EXPECT_NE(measured.waitForExit(), 0) << caught.text();
    said = caught.text();
  }
  EXPECT_NE(said.find("lost>=0: it is not measured to the end"), std::string::npos) << said;
}

TEST(Latency, AssertionsThatHoldEndWithCode0) {
  const FakeServer server(exclusiveDomain(), {});
  const auto result =
      runProgram("palpate-latency", onDomain({"--seconds", "1", "--assert", "received>100", "--assert",
                                              "answered_pose_to_force_us.count>100"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST(Latency, AnAssertionThatDoesNotReadIsRefusedBeforeAServerIsLookedFor) {
  const auto result =
      runProgram("palpate-latency", onDomain({"--wait", "0", "--assert", "pose_to_force.p99<500"}));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("no figure 'pose_to_force.p99'"), std::string::npos) << result.err;
}

TEST(Latency, MoreToolsThanThereAreIdsAreRefused) {
  const auto result = runProgram("palpate-latency", onDomain({"--tool", "2", "--tools", "3"}));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("--tools 3 with --tool 2: ids end at 3"), std::string::npos) << result.err;
}

TEST(Latency, ReportsWhatTheServerSaysAndWhatIsLost) {
  const FakeServer server(exclusiveDomain(), {.drop_every = 100, .overrun_every = 50});
  const TemporaryFile svg("latency.svg");
  const auto result =
      runProgram("palpate-latency", onDomain({"--seconds", "1.5", "--json", "--plot", svg.path()}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  for (const char* key : {"pose_to_force_us", "wakeup_us", "tick_us"})
    for (const char* value : {"p50", "p99", "p999", "max", "count"})
      EXPECT_TRUE(report[key][value].is_number()) << key;
  EXPECT_EQ(report["pose_to_field_us"]["count"], 0) << "no fields were read";
  EXPECT_NEAR(report["wakeup_us"]["p50"].get<double>(), 50.0, 1.0);
  EXPECT_NEAR(report["tick_us"]["max"].get<double>(), 70.0, 1e-9);
  EXPECT_GT(report["pose_to_force_us"]["p50"].get<double>(), 0.0);
  EXPECT_LE(report["pose_to_force_us"]["p50"].get<double>(),
            report["pose_to_force_us"]["p999"].get<double>());
  EXPECT_GE(report["lost"].get<double>(), report["received"].get<double>() / 99.0 - 2.0);
  const double answered = report["received"].get<double>() + report["lost"].get<double>();
  EXPECT_NEAR(report["overruns"].get<double>(), answered / 50.0, 2.0);
  EXPECT_NEAR(report["seconds"].get<double>(), 1.5, 0.5);
  EXPECT_TRUE(report["late"].is_number_unsigned());
  for (const char* cause :
       {"own_work", "page_fault", "preempted", "stopped", "host_steal", "clock_step", "unknown"})
    EXPECT_EQ(report["late_ticks"][cause], 0) << "this server says of no tick that it was late";
  EXPECT_EQ(report["late_ticks"]["preempted_by"], "");
  EXPECT_NE(result.err.find("\nlate ticks: none\n"), std::string::npos) << result.err;
  EXPECT_EQ(xmlFault(contentOf(svg.path())), "");
}

}  // namespace
}  // namespace palpate::testing
