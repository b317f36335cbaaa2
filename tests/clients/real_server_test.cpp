// SPDX-License-Identifier: Apache-2.0
// The client programs against palpate-server itself, on a model known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "palpate/idl/types.h"
#include "palpate/testing/child_process.h"
#include "palpate/testing/run_program.h"
#include "running_server.h"

namespace palpate::testing {
namespace {

using nlohmann::json;

TEST(RealServer, PressIsPushedBackAlongTheNormal) {
  const Running server;
  const json report = server.run("palpate-tool", {"--script", "press", "--depth", "0.002", "--seconds", "2"});
  ASSERT_FALSE(report.is_null());
  // Normal stiffness 450 N/m, 2 mm deep, and a little for the higher terms; the model's fading nonlinearity
  // is 10 %.
  EXPECT_NEAR(report["summary"]["peak_force_N"].get<double>(), 0.9, 0.1);
  const auto& force = report["summary"]["peak_force_vector_N"];
  EXPECT_GT(force[2].get<double>(), 0.8);
  EXPECT_LT(std::hypot(force[0].get<double>(), force[1].get<double>()), 0.05);
  EXPECT_GT(report["summary"]["contact_s"].get<double>(), 0.5);
  EXPECT_FALSE(report["summary"]["server_left"].get<bool>());
}

// Who drives which tool, and for which device each is set.
TEST(RealServer, IsListedWithItsOrganItsToolsAndWhoDrivesThem) {
  const Running server({"--device", "touch", "--tool", "1:device=omni", "--server-id", "3"});
  const CaughtOutput said;
  ChildProcess driver(
      "palpate-tool",
      {"--tool", "1", "--script", "press", "--seconds", "30", "--wait", "30", "--domain", server.domain},
      {said.descriptor(), said.descriptor()});
  json found;
  for (int i = 0; i < 20 && (found.is_null() || found["publishers"].empty()); ++i) {
    const auto result = runProgram("palpate-list", {"--json", "--timeout", "1", "--domain", server.domain});
    ASSERT_TRUE(result.exit_code == 0 || i < 19) << result.err;
    if (result.exit_code == 0) found = json::parse(result.out);
  }
  ASSERT_EQ(found["servers"].size(), 1U) << found;
  const json& listed = found["servers"][0];
  EXPECT_EQ(listed["server_id"], 3);
  ASSERT_EQ(listed["organs"].size(), 1U);
  EXPECT_GT(listed["organs"][0]["surface_nodes"], 100);
  EXPECT_EQ(listed["organs"][0]["model_id"], listed["model_id"]);
  EXPECT_GT(listed["organs"][0]["size_m"][2], 0.01);
  EXPECT_EQ(listed["tools"][0]["device"], "touch");
  EXPECT_EQ(listed["tools"][1]["device"], "omni");
  ASSERT_EQ(found["publishers"].size(), 1U) << found;
  EXPECT_EQ(found["publishers"][0]["tool_id"], 1);
  EXPECT_EQ(found["publishers"][0]["process"], "palpate-tool");
  EXPECT_GT(found["publishers"][0]["rate_hz"], 100.0);
  driver.signal(SIGINT);
  EXPECT_EQ(driver.waitForExit(), 0);
  const auto text = runProgram("palpate-list", {"--timeout", "1", "--domain", server.domain});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("tool 1    omni"), std::string::npos) << text.out;
}

TEST(RealServer, ADeviceIsToldThatItsToolIsSetForAnother) {
  const Running server({"--device", "touch", "--tool", "1:device=omni"});
  const auto notes = [&](const char* preset, const char* tool) {
    return runProgram("palpate-device", {"--preset", preset, "--tool", tool, "--motion", "press", "--seconds",
                                         "2", "--wait", "30", "--domain", server.domain})
        .err;
  };
  EXPECT_EQ(notes("omni", "1").find("note: the server is set"), std::string::npos);
  EXPECT_NE(
      notes("touch", "1").find("note: the server is set for device 'omni' at tool 1, this is 'touch'\n"),
      std::string::npos);
  EXPECT_NE(notes("omni", "0").find("note: the server is set for device 'touch' at tool 0, this is 'omni'\n"),
            std::string::npos);
}

TEST(RealServer, ASimulatedDeviceComesToRestOnTheOrgan) {
  const Running server({"--device", "touch"});
  const json report = server.run("palpate-device", {"--preset", "touch", "--hand", "0.1,2,200", "--motion",
                                                    "press", "--seconds", "2.5"});
  ASSERT_FALSE(report.is_null());
  EXPECT_TRUE(report["stable"]);
  EXPECT_FALSE(report["settle_s"].is_null());
  EXPECT_GT(report["penetration_m"].get<double>(), 5e-4);
  EXPECT_LT(report["penetration_m"].get<double>(), 0.003) << "the organ holds against the hand";
  EXPECT_GT(report["max_force_N"].get<double>(), 0.1);
  EXPECT_LE(report["max_force_N"].get<double>(), 3.3 + 1e-9);
  EXPECT_EQ(report["server_device"], "touch");
  EXPECT_NE(report["flags"].get<unsigned>() & dds::flag::kInContact, 0U);
  EXPECT_EQ(report["tip_m"].size(), 2501U);
}

TEST(RealServer, ADriverFromTheTemplateFeelsTheOrgan) {
  const Running server;
  const auto result = runProgram("palpate-driver-template", {"--domain", server.domain, "--origin", "0", "0",
                                                             "0.058", "--seconds", "3"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  double largest = 0.0;
  ASSERT_EQ(std::sscanf(result.out.c_str(), "largest force %lf N", &largest), 1) << result.out;
  EXPECT_GT(largest, 0.3) << "its fake device goes 5 mm below the top of the organ";
  EXPECT_LE(largest, 3.3 + 1e-4);
}

TEST(RealServer, ADriverWhosePosesAreInMillimetresIsToldThatItNeverTouched) {
  const Running server;
  const auto result = runProgram("palpate-driver-template",
                                 {"--domain", server.domain, "--origin", "0", "0", "58", "--seconds", "1"});
  EXPECT_NE(result.out.find(
                "the tool never touched the organ: it stayed at least 57.9 m from it; poses are in metres\n"),
            std::string::npos)
      << result.out << result.err;
}

TEST(RealServer, AProgramFromTheIdlAloneWithDefaultQosFeelsTheOrgan) {
  const Running server;
  const auto result = runProgram("palpate-example-touch", {server.domain});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  double largest = 0.0;
  int answers = 0;
  ASSERT_EQ(std::sscanf(result.out.c_str(), "largest force %lf N, %d answers", &largest, &answers), 2)
      << result.out;
  EXPECT_GT(largest, 0.3) << "it presses 3 mm deep";
  EXPECT_LE(largest, 3.3 + 1e-4);
  EXPECT_GT(answers, 500);
}

TEST(RealServer, LatencyAndWatchReportTheSameRun) {
  const Running server;
  json watched;
  std::thread watch([&] { watched = server.run("palpate-watch", {"--seconds", "4"}); });
  const TemporaryFile samples("samples.csv");
  const json report =
      server.run("palpate-latency", {"--seconds", "2", "--fields", "--samples", samples.path().string()});
  watch.join();
  ASSERT_FALSE(report.is_null());
  ASSERT_FALSE(watched.is_null());
  EXPECT_GT(report["pose_to_force_us"]["count"].get<int>(), 500);
  EXPECT_GT(report["pose_to_field_us"]["count"].get<int>(), 500);
  EXPECT_GT(report["pose_to_field_us"]["p50"].get<double>(), report["tick_us"]["p50"].get<double>());
  EXPECT_GT(report["tick_us"]["p50"].get<double>(), 0.0);
  EXPECT_LE(report["lost"].get<double>(), 0.01 * report["received"].get<double>());
  EXPECT_GT(watched["received"].get<int>(), 500);
  EXPECT_EQ(watched["refused"], 0);
  const std::string table = contentOf(samples.path());
  EXPECT_EQ(table.find("seq,sent_s,answered_s,lost\n0,0.000000000,"), 0U);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), report["sent"].get<long>() + 1);
  EXPECT_EQ(watched["model_id"], report["model_id"]);
  EXPECT_GT(watched["peak"]["size"].get<double>(), 1e-5);
}

}  // namespace
}  // namespace palpate::testing
