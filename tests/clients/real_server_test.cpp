// SPDX-License-Identifier: Apache-2.0
// The client programs against palpate-server itself, on a model known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "palpate/idl/types.h"
#include "palpate/testing/child_process.h"
#include "palpate/testing/run_program.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"

namespace palpate::testing {
namespace {

using nlohmann::json;

struct Running {
  TemporaryFile model{"clients-e2e.h5"};
  std::string domain{std::to_string(exclusiveDomain())};
  std::unique_ptr<ServerProcess> process;

  // By default the model's own force, no coupling.
  explicit Running(const std::vector<std::string>& options = {"--device", "custom", "--friction", "inf"}) {
    writeSyntheticModel(model.path());
    std::vector<std::string> arguments{"--model", model.path().string(), "--domain", domain};
    arguments.insert(arguments.end(), options.begin(), options.end());
    process = std::make_unique<ServerProcess>(arguments);
  }
  [[nodiscard]] json run(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--json", "--wait", "30", "--domain", domain});
    const auto result = runProgram(program, arguments);
    EXPECT_EQ(result.exit_code, 0) << program << ": " << result.err;
    return result.exit_code == 0 ? json::parse(result.out) : json();
  }
};

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

// Two tools, recorded; then a server of a fresh start gets their poses again.
TEST(RealServer, AnswersARecordedSessionAsItDidWhenItIsPlayedBack) {
  const TemporaryFile recording("playback.rec");
  const std::vector<std::string> options{"--device", "touch",  "--friction",
                                         "0.2",      "--tool", "2:tip-radius=0.004"};
  {
    std::vector<std::string> recording_options = options;
    recording_options.insert(recording_options.end(), {"--record", recording.path().string()});
    const Running server(recording_options);
    std::thread second([&] {
      (void)server.run("palpate-tool", {"--tool", "2", "--script", "poke", "--pokes", "6", "--at", "0.05,0,0",
                                        "--depth", "0.002", "--seconds", "5"});
    });
    (void)server.run("palpate-tool", {"--script", "slide", "--depth", "0.002", "--seconds", "5"});
    second.join();
    server.process->signal(SIGTERM);
    ASSERT_EQ(server.process->waitForExit(), 0) << server.process->log();
  }
  const Running server(options);
  json report;
  for (int tries = 0; tries < 4 && !(report.is_object() && report["holds"]);
       ++tries) {  // again where the machine stalled
    const auto result =
        runProgram("palpate-tool", {"--script", "recording", recording.path().string(), "--within", "1",
                                    "--json", "--wait", "30", "--domain", server.domain});
    ASSERT_TRUE(result.exit_code == 0 || result.exit_code == 3) << result.err;
    report = json::parse(result.out);
    EXPECT_EQ(result.exit_code == 0, report["holds"].get<bool>()) << result.err;
    ASSERT_EQ(report["tools"].size(), 2U);
    for (const json& tool : report["tools"])
      if (!tool["summary"]["largest_difference"].is_null()) {
        EXPECT_LT(tool["summary"]["largest_difference"].get<double>(), 0.01) << tool["summary"];
      }
  }
  EXPECT_TRUE(report["holds"]) << "at least half of the answers are compared";
  EXPECT_EQ(report["recorded_model_id"], report["model_id"]);
  EXPECT_NEAR(report["seconds"].get<double>(), 5.0, 1.0);
  for (const json& tool : report["tools"]) {
    const json& summary = tool["summary"];
    EXPECT_EQ(tool["timed_by"], "stamps");
    EXPECT_EQ(tool["sent_as"], tool["tool"]);
    EXPECT_GT(summary["largest_recorded_force_N"].get<double>(), 0.1) << "it touched the organ";
    EXPECT_GT(summary["sent"].get<int>(), 3000);
  }
  // One tool as another one.
  const json one = server.run("palpate-tool", {"--script", "recording", recording.path().string(),
                                               "--recorded-tool", "0", "--tool", "1", "--seconds", "1"});
  ASSERT_FALSE(one.is_null());
  ASSERT_EQ(one["tools"].size(), 1U);
  EXPECT_EQ(one["tools"][0]["sent_as"], 1);
  EXPECT_TRUE(one["holds"].is_null());
}

TEST(RealServer, OfAnotherStiffnessAnswersARecordedSessionOtherwise) {
  const TemporaryFile recording("softer.rec");
  {
    const Running server({"--device", "custom", "--record", recording.path().string()});
    (void)server.run("palpate-tool", {"--script", "press", "--depth", "0.002", "--seconds", "2"});
    server.process->signal(SIGTERM);
    ASSERT_EQ(server.process->waitForExit(), 0) << server.process->log();
  }
  const Running server({"--device", "custom", "--youngs-modulus", "9e4"});
  const auto result =
      runProgram("palpate-tool", {"--script", "recording", recording.path().string(), "--within", "1",
                                  "--json", "--wait", "30", "--domain", server.domain});
  ASSERT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.err.find("forces differ by more than 1 % of the largest, or"), std::string::npos)
      << result.err;
  EXPECT_FALSE(json::parse(result.out)["holds"]);
}

// Of delays in a file palpate-feel makes a server's configuration; palpate-device, with the same delays, is stable with it and with a
// fifth less, and rings with two fifths more than the largest stable one.
TEST(RealServer, UnderDelaysADeviceIsStableWithTheCouplingThatWasFoundForThem) {
  const TemporaryFolder folder;
  const std::string delays = (folder / "delays.csv").string();
  {
    std::ofstream file(delays);
    file << "seq,sent_s,answered_s,lost\n";
    for (int i = 0; i < 5000; ++i)
      file << i << ',' << 1e-3 * i << ','
           << (i % 40 == 7 ? std::string(",1")
                           : std::to_string(1e-3 * i + 2.4e-3 + 1e-3 * (i * 7 % 4)) + ",0")
           << '\n';
  }
  writeSyntheticModel(folder / "organ.h5");
  const auto found =
      runProgram("palpate-feel", {"coupling", (folder / "organ.h5").string(), "--delay-from", delays,
                                  "--preset", "desktop", "--settings", folder.path().string(), "--json"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const json row = json::parse(found.out)[0];
  EXPECT_EQ(row["bound"], "delays");
  const double stiffness = row["safe_rendered_N_per_m"].get<double>(),
               damping = row["safe_damping_Ns_per_m"].get<double>();
  // Again where the machine stalled and the server blended the force: what is shown is the loop's.
  const auto press = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all{"--youngs-modulus", "1e6"};
    all.insert(all.end(), options.begin(), options.end());
    const Running server(all);
    ProgramResult result;
    for (int tries = 0; tries < 5; ++tries) {
      result = runProgram("palpate-device",
                          {"--preset", "desktop", "--friction", "0", "--hand", "0.02,0.5,50", "--delay-from",
                           delays, "--seconds", "4", "--json", "--wait", "30", "--domain", server.domain});
      if (result.out.empty() || json::parse(result.out)["flags"] == dds::flag::kInContact) break;
    }
    return result;
  };
  const auto times = [&](double share) {
    return std::vector<std::string>{"--device",
                                    "desktop",
                                    "--rendered-stiffness",
                                    std::to_string(share * stiffness),
                                    "--coupling-damping",
                                    std::to_string(share * damping)};
  };
  const auto below = press(times(0.8));
  EXPECT_EQ(below.exit_code, 0) << below.err;
  EXPECT_NEAR(json::parse(below.out)["delays"]["mean_ms"].get<double>(), row["mean_delay_ms"].get<double>(),
              1e-9);
  const auto found_one = press({"--config", (folder / "desktop.toml").string()});
  EXPECT_EQ(found_one.exit_code, 0) << found_one.err;
  const auto above = press(times(1.4 * row["largest_stable_N_per_m"].get<double>() / stiffness));
  EXPECT_EQ(above.exit_code, 3) << above.err;
  EXPECT_NE(above.err.find("UNSTABLE"), std::string::npos) << above.err;
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
