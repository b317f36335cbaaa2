// SPDX-License-Identifier: Apache-2.0
// Recorded sessions and measured delays, played against palpate-server itself.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "palpate/idl/types.h"
#include "palpate/testing/run_program.h"
#include "running_server.h"
#include "stood_still.h"

namespace palpate::testing {
namespace {

// Two tools, recorded; then a server of a fresh start gets their poses again.
TEST(PlayedSession, AnswersARecordedSessionAsItDidWhenItIsPlayedBack) {
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
  EXPECT_TRUE(report["holds"]) << "the answers to at least half of the poses are compared";
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

TEST(PlayedSession, OfAnotherStiffnessAnswersARecordedSessionOtherwise) {
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
// fifth less, and rings with two fifths more.
TEST(DelayedDevice, IsStableWithTheCouplingThatWasFoundForItsDelays) {
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
  // Stalls damp what rings and shake what does not: a run that they disturbed may confirm, but not contradict. Nothing where
  // the machine let no run do either.
  const auto press = [&](const std::vector<std::string>& options,
                         int expected) -> std::optional<ProgramResult> {
    std::vector<std::string> all{"--youngs-modulus", "1e6", "--phase-lock"};
    all.insert(all.end(), options.begin(), options.end());
    const Running server(all);
    for (int tries = 0; tries < 6; ++tries) {
      ProgramResult result =
          runProgram("palpate-device", {"--preset", "desktop", "--delay-from", delays, "--json", "--seconds",
                                        "6", "--wait", "30", "--domain", server.domain});
      if (stoodStill(result)) continue;
      const json said = json::parse(result.out);
      if (result.exit_code == expected || said["flags"] == dds::flag::kInContact) return result;
    }
    return std::nullopt;
  };
  const auto times = [&](double share) {
    return std::vector<std::string>{"--device",
                                    "desktop",
                                    "--rendered-stiffness",
                                    std::to_string(share * stiffness),
                                    "--coupling-damping",
                                    std::to_string(share * damping)};
  };
  const auto below = press(times(0.8), 0),
             found_one = press({"--config", (folder / "desktop.toml").string()}, 0),
             above = press(times(1.4), 3);
  if (!below || !found_one || !above) GTEST_SKIP() << "the machine stood still in each of six runs";
  EXPECT_EQ(below->exit_code, 0) << below->err;
  EXPECT_NEAR(json::parse(below->out)["delays"]["mean_ms"].get<double>(), row["mean_delay_ms"].get<double>(),
              1e-9);
  EXPECT_EQ(found_one->exit_code, 0) << found_one->err;
  EXPECT_EQ(above->exit_code, 3) << above->err;
  EXPECT_NE(above->err.find("UNSTABLE"), std::string::npos) << above->err;
}

}  // namespace
}  // namespace palpate::testing
