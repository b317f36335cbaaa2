// SPDX-License-Identifier: Apache-2.0
// palpate-tool as a process, against a small server inside the test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "fake_server.h"
#include "on_domain.h"
#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"
#include "palpate/testing/test_domain.h"
#include "palpate/testing/xml_fault.h"

namespace palpate::testing {
namespace {

using nlohmann::json;

TEST(Tool, PressFeelsTheSpring) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 500.0, .tip_radius = 0.004});
  const TemporaryFile svg("press.svg");
  const auto result = runProgram("palpate-tool", onDomain({"--script", "press", "--seconds", "1.5", "--depth",
                                                           "0.002", "--json", "--plot", svg.path()}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report["node"], 15);
  EXPECT_EQ(report["tip_radius"], 0.004);  // the server's
  const std::size_t count = report["t_s"].size();
  EXPECT_GT(count, 100U);
  for (const char* array : {"pose_m", "force_N", "flags", "penetration_m", "work_J"})
    EXPECT_EQ(report[array].size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const double depth = std::max(0.0, 0.054 - report["pose_m"][i][2].get<double>());
    EXPECT_NEAR(report["force_N"][i][2].get<double>(), 500.0 * depth, 1e-9)
        << i;  // each force belongs to its pose
    EXPECT_NEAR(report["work_J"][i].get<double>(), 0.5 * 500.0 * depth * depth, 2e-6) << i;
  }
  EXPECT_NEAR(report["summary"]["peak_force_N"].get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(report["summary"]["peak_depth_m"].get<double>(), 0.002, 1e-9);
  EXPECT_EQ(report["summary"]["sent"].get<std::size_t>(),
            count + report["summary"]["unanswered"].get<std::size_t>());
  EXPECT_LE(report["summary"]["superseded"].get<std::size_t>(),
            report["summary"]["unanswered"].get<std::size_t>());
  EXPECT_EQ(xmlFault(contentOf(svg.path())), "");
}

TEST(Tool, PressesBesideAndComparesBoth) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 500.0, .tip_radius = 0.004});
  const TemporaryFile svg("both.svg");
  const auto result = runProgram(
      "palpate-tool", onDomain({"--script", "press", "--seconds", "1", "--depth", "0.002", "--at",
                                "0.05,0.05,0.05", "--beside", "0.1,0.1,0", "--json", "--plot", svg.path()}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report["node"], 15);
  EXPECT_EQ(report["beside"]["node"], 13);
  EXPECT_NEAR(report["summary"]["peak_force_N"].get<double>(), 1.0, 1e-6);
  EXPECT_GT(report["beside"]["summary"]["peak_force_N"].get<double>(), 5.0);  // the wall is at the apex
  EXPECT_NE(result.err.find("peak force 1.0000 N here, 2"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("N beside: -9"), std::string::npos) << result.err;
  const std::string plot = contentOf(svg.path());
  EXPECT_EQ(xmlFault(plot), "");
  EXPECT_NE(plot.find("here, node"), std::string::npos);
  EXPECT_NE(plot.find("beside, node"), std::string::npos);
  const auto wrong = runProgram("palpate-tool", {"--beside", "1,2"});
  EXPECT_NE(wrong.exit_code, 0);
  EXPECT_NE(wrong.err.find("--beside"), std::string::npos) << wrong.err;
}

TEST(Tool, SaysHowFarThePlaceIsFromTheOrgan) {
  const FakeServer server(exclusiveDomain(), {});
  const auto result = runProgram("palpate-tool", onDomain({"--at", "0.05,0.05,0.052", "--seconds", "0.5"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("--at lies 2 mm from the organ's surface\n"), std::string::npos) << result.err;
}

TEST(Tool, FailsWhenItNeverTouchesTheOrgan) {
  const FakeServer server(exclusiveDomain(), {.tip_radius = 0.0});
  const auto result =
      runProgram("palpate-tool", onDomain({"--tip-radius", "0.02", "--depth", "0.003", "--seconds", "2"}));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("palpate-tool: the tool never touched the organ: its centre stayed at least 17"),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find(" mm from the surface; poses are in metres\n"), std::string::npos) << result.err;
}

TEST(Tool, ForcesOfAnotherServerAreLeftOutAndToldByName) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 500.0});
  const FakeServer rival(exclusiveDomain(),
                         {.stiffness = 9000.0, .server_id = 1, .session = 2, .first_seq = 122'917'840});
  bool told = false;  // at the start, of a rival that is known by then
  for (int tries = 0; tries < 5 && !told; ++tries) {
    const auto result = runProgram("palpate-tool", onDomain({"--script", "press", "--seconds", "1", "--depth",
                                                             "0.002", "--server-id", "0", "--json"}));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json summary = json::parse(result.out)["summary"];
    EXPECT_NEAR(summary["peak_force_N"].get<double>(), 1.0, 1e-6);
    EXPECT_LT(summary["lost"].get<std::size_t>(), 1000U);
    EXPECT_GT(summary["left_out"].get<std::size_t>(), 200U);
    EXPECT_NE(result.err.find("left out: server 1, session 0000000000000002, on bench"), std::string::npos)
        << result.err;
    told = result.err.find("note: held on to server 0") != std::string::npos;
  }
  EXPECT_TRUE(told);
}

TEST(Tool, ARecordingIsRefusedBeforeAServerIsLookedFor) {
  const auto refused = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--wait", "0"});
    const auto result = runProgram("palpate-tool", onDomain(arguments));
    return std::pair(result.exit_code, result.err);
  };
  const TemporaryFile no_recording("no.rec");
  std::ofstream(no_recording.path()) << "poses";
  EXPECT_EQ(refused({"--script", "recording", no_recording.path().string()}),
            std::pair(1, "palpate-tool: " + no_recording.path().string() +
                             ": is no recording of palpate-server\n"));
  EXPECT_EQ(refused({"--script", "recording"}),
            std::pair(2, std::string("palpate-tool: --script recording: which? --script recording FILE\n")));
  EXPECT_EQ(refused({"session.rec"}).second,
            "palpate-tool: session.rec: only --script recording plays a file\n");
  EXPECT_EQ(refused({"--within", "1"}).first, 2);
  EXPECT_EQ(refused({"--script", "recording", "session.rec", "--at", "0,0,0"}).first, 2);
}

TEST(Tool, TableGoesToStandardOutputWithoutJson) {
  const FakeServer server(exclusiveDomain(), {});
  const auto result =
      runProgram("palpate-tool", onDomain({"--script", "poke", "--pokes", "2", "--seconds", "0.8"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("peak force 1.5"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("retreat"), std::string::npos);
}

TEST(Tool, StopsWhenTheServerLeaves) {
  const FakeServer server(exclusiveDomain(), {.leave_after = 200});
  const auto result =
      runProgram("palpate-tool", onDomain({"--script", "press", "--seconds", "60", "--json"}));
  ASSERT_EQ(result.exit_code, 1) << result.err;
  EXPECT_TRUE(json::parse(result.out)["summary"]["server_left"]);
}

}  // namespace
}  // namespace palpate::testing
