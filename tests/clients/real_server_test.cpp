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

TEST(RealServer, FourToolsAreMeasuredAtOnce) {
  const Running server;
  const json report = server.run("palpate-latency", {"--seconds", "1.5", "--tools", "4"});
  ASSERT_FALSE(report.is_null());
  ASSERT_EQ(report["tools"].size(), 4U);
  double worst = 0.0;
  for (int id = 0; id < 4; ++id) {
    const json& tool = report["tools"][static_cast<std::size_t>(id)];
    EXPECT_EQ(tool["tool_id"], id);
    EXPECT_GT(tool["received"], 1000);
    EXPECT_GT(tool["answered_pose_to_force_us"]["count"], 500);
    worst = std::max(worst, tool["pose_to_force_us"]["p99"].get<double>());
  }
  EXPECT_EQ(report["pose_to_force_us"]["p99"].get<double>(), worst);
}

TEST(RealServer, OfSeveralTheOneWithTheOrganThatIsNamedIsChosen) {
  const Running first({"--server-id", "1", "--organ-id", "11", "--addressed-only"});
  const Running second({"--server-id", "2", "--organ-id", "22", "--addressed-only", "--device", "omni",
                        "--tip-radius", "0.007", "--rate", "500"});
  EXPECT_EQ(first.run("palpate-parameters", {"--organ-id", "22"})["server_id"], 2);
  EXPECT_EQ(first.run("palpate-parameters", {"--organ-id", "11"})["server_id"], 1);
  EXPECT_EQ(first.run("palpate-tool", {"--organ-id", "22", "--seconds", "0.5"})["tip_radius"], 0.007);
  EXPECT_EQ(first.run("palpate-tool", {"--organ-id", "11", "--seconds", "0.5"})["tip_radius"], 0.005);
  EXPECT_EQ(first.run("palpate-latency", {"--organ-id", "22", "--seconds", "1"})["server_rate_hz"], 500.0);
  EXPECT_EQ(first.run("palpate-device", {"--organ-id", "22", "--preset", "omni"})["server_device"], "omni");
  for (const char* program :
       {"palpate-parameters", "palpate-tool", "palpate-latency", "palpate-device", "palpate-watch"}) {
    const auto result = runProgram(program, {"--organ-id", "33", "--wait", "1", "--domain", first.domain});
    EXPECT_EQ(result.exit_code, 1) << program;
    EXPECT_NE(result.err.find("no server with organ 33 on DDS domain"), std::string::npos) << result.err;
  }
  const auto driver = [&](const char* organ) {
    return runProgram("palpate-driver-template",
                      {"--organ-id", organ, "--domain", first.domain, "--seconds", "1"});
  };
  for (const char* organ : {"11", "22"})
    EXPECT_EQ(driver(organ).out.find("; 0 periods with a force"), std::string::npos) << organ;
  const auto nobody = driver("33");
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_NE(nobody.err.find("no server with organ 33 on DDS domain"), std::string::npos) << nobody.err;
}

TEST(RealServer, AnIdThatNoServerCanHaveIsRefused) {
  for (const char* program : {"palpate-parameters", "palpate-tool", "palpate-latency", "palpate-device",
                              "palpate-watch", "palpate-driver-template"})
    for (const auto& [option, most] :
         {std::pair{"--organ-id", "4294967295"}, std::pair{"--server-id", "4294967294"}})
      for (const char* id : {"-1", "4294967296"}) {
        const auto result = runProgram(program, {option, id});
        EXPECT_EQ(result.exit_code, 2) << program;
        EXPECT_NE(result.err.find(most), std::string::npos) << program << ' ' << option << ": " << result.err;
      }
}

TEST(RealServer, AToolThatGoesOnOverAnotherModelSaysSo) {
  const TemporaryFolder models;
  writeSyntheticModel(models / "next.h5", {.stiffness = 600.0});
  const Running server({"--device", "custom", "--models", models.path().string()});
  const CaughtOutput said;
  ChildProcess tool("palpate-tool",
                    {"--script", "press", "--seconds", "6", "--wait", "30", "--domain", server.domain},
                    {said.descriptor(), said.descriptor()});
  std::this_thread::sleep_for(std::chrono::seconds(2));
  EXPECT_TRUE(server.run("palpate-parameters", {"--model", "next.h5"})["accepted"]);
  EXPECT_EQ(tool.waitForExit(), 0) << said.text();
  EXPECT_NE(said.text().find("note: the server took another model once meanwhile"), std::string::npos)
      << said.text();
}

// One server with its organ and both devices, and one publisher that sends.
bool isComplete(const json& listing) {
  if (!listing.is_object() || listing["servers"].size() != 1 || listing["publishers"].size() != 1)
    return false;
  const json &server = listing["servers"][0], &publisher = listing["publishers"][0];
  return server["organs"].size() == 1 && server["tools"][0]["device"].is_string() &&
         server["tools"][1]["device"].is_string() && publisher["sends"] == true &&
         publisher["rate_hz"].get<double>() > 10.0;
}

// Who drives which tool, and for which device each is set.
TEST(RealServer, IsListedWithItsOrganItsToolsAndWhoDrivesThem) {
  const Running server({"--device", "touch", "--tool", "1:device=omni", "--server-id", "3"});
  const CaughtOutput said;
  ChildProcess driver(
      "palpate-tool",
      {"--tool", "1", "--script", "press", "--seconds", "300", "--wait", "30", "--domain", server.domain},
      {said.descriptor(), said.descriptor()});
  // A listing shows what came within its time: it is asked again until all is in it.
  json found;
  for (int i = 0; i < 20 && !isComplete(found); ++i)
    found =
        json::parse(runProgram("palpate-list", {"--json", "--timeout", "2", "--domain", server.domain}).out);
  ASSERT_TRUE(isComplete(found)) << found;
  const json& listed = found["servers"][0];
  EXPECT_EQ(listed["server_id"], 3);
  EXPECT_GT(listed["organs"][0]["surface_nodes"], 100);
  EXPECT_EQ(listed["organs"][0]["model_id"], listed["model_id"]);
  EXPECT_GT(listed["organs"][0]["size_m"][2], 0.01);
  EXPECT_EQ(listed["tools"][0]["device"], "touch");
  EXPECT_EQ(listed["tools"][1]["device"], "omni");
  EXPECT_EQ(found["publishers"][0]["tool_id"], 1);
  EXPECT_EQ(found["publishers"][0]["process"], "palpate-tool");
  driver.signal(SIGINT);
  EXPECT_EQ(driver.waitForExit(), 0);
  std::string text;
  for (int i = 0; i < 20 && text.find("tool 1    omni") == std::string::npos; ++i)
    text = runProgram("palpate-list", {"--timeout", "2", "--domain", server.domain}).out;
  EXPECT_NE(text.find("tool 1    omni"), std::string::npos) << text;
}

TEST(RealServer, ADeviceIsToldThatItsToolIsSetForAnother) {
  const Running server({"--device", "touch", "--tool", "1:device=omni"});
  // Asked again where a busy machine kept the server's answer or ended the run. A run that was judged has told its notes.
  const auto noteOf = [&](const char* preset, const char* tool) -> std::string {
    for (int i = 0; i < 5; ++i) {
      const auto run =
          runProgram("palpate-device", {"--preset", preset, "--tool", tool, "--motion", "press", "--seconds",
                                        "2", "--wait", "30", "--domain", server.domain});
      if (run.exit_code != 0 && run.exit_code != 3) continue;
      const std::size_t begin = run.err.find("note: the server ");
      if (begin == std::string::npos) return "none";
      const std::string note = run.err.substr(begin, run.err.find('\n', begin) - begin);
      if (note.find("does not say") == std::string::npos) return note;
    }
    return "no answer";
  };
  EXPECT_EQ(noteOf("omni", "1"), "none");
  EXPECT_EQ(noteOf("touch", "1"), "note: the server is set for device 'omni' at tool 1, this is 'touch'");
  EXPECT_EQ(noteOf("omni", "0"), "note: the server is set for device 'touch' at tool 0, this is 'omni'");
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
  const std::size_t line = result.out.find("largest force ");  // before it may stand that answers came late
  ASSERT_NE(line, std::string::npos) << result.out;
  ASSERT_EQ(std::sscanf(result.out.c_str() + line, "largest force %lf N", &largest), 1) << result.out;
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
  EXPECT_EQ(result.exit_code, 1);
}

TEST(RealServer, ADriverOfAToolThatTheServerDoesNotHaveIsToldSo) {
  const Running server({"--device", "custom", "--tools", "1"});
  const auto result =
      runProgram("palpate-driver-template", {"--domain", server.domain, "--tool", "2", "--seconds", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.out.find("the server has no tool 2: "), std::string::npos) << result.out << result.err;
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
  EXPECT_GT(report["force_out_us"]["count"].get<int>(), 500);
  EXPECT_GT(report["receive_us"]["count"].get<int>(), 500) << "the sender is on the server's host";
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
