// SPDX-License-Identifier: Apache-2.0
// tools/latency-report as a whole, against a real server on a synthetic model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "palpate/testing/paths.h"
#include "palpate/testing/run_program.h"
#include "palpate/testing/synthetic_model.h"

namespace palpate::testing {

namespace {

using ::testing::HasSubstr;

void expectTimes(const nlohmann::json& times, const std::string& name) {
  ASSERT_TRUE(times.contains("p50") && times.contains("p99")) << name;
  EXPECT_GT(times["p50"], 0.0) << name;
  EXPECT_GE(times["p99"], times["p50"]) << name;
}

}  // namespace

TEST(LatencyReport, MeasuresAllInTurnAndWritesTableFigureAndJson) {
  for (const char* program : {"cyclictest", "ddsperf"})
    if (!isInstalled(program)) GTEST_SKIP() << program << " is not installed (rt-tests, cyclonedds-tools)";
  const TemporaryFile model("report.h5");
  const TemporaryFolder out;
  writeSyntheticModel(model.path(), {.subdivisions = 3, .modes = 8});
  const std::filesystem::path json_file = out.path() / "report.json";
  const ProgramResult made = runProgram(std::string(PALPATE_TOOLS_DIR) + "/latency-report",
                                        {"--quick", "--bin", binDir(), "--model", model.path().string(),
                                         "--out", out.path().string(), "--json", json_file.string()});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = nlohmann::json::parse(contentOf(json_file));
  for (const nlohmann::json& state : {json, json["loaded"]}) {
    for (const char* key : {"cyclictest", "wakeup", "tick", "ddsperf_roundtrip", "pose_to_force",
                            "pose_to_force_less_wait", "pose_to_field"})
      expectTimes(state[key], key);
    for (const char* viewers : {"0", "1", "4", "4_one_stopped"})
      expectTimes(state["force_with_viewers"][viewers], viewers);
    ASSERT_TRUE(state.contains("pose_to_force_phase_locked"));
    if (json["about"]["phase_lock"] == true) expectTimes(state["pose_to_force_phase_locked"], "locked");
    EXPECT_LT(state["pose_to_force_less_wait"]["p50"], state["pose_to_force"]["p50"])
        << "991 Hz goes through all waits";
  }
  EXPECT_THAT(contentOf(out.path() / "report.txt"), HasSubstr("== other processors busy"));
  EXPECT_THAT(contentOf(out.path() / "report.md"), HasSubstr("| wake-up lateness: tick | "));
  if (isInstalled("gnuplot")) {
    EXPECT_THAT(contentOf(out.path() / "report.svg"), HasSubstr("</svg>"));
  }
}

}  // namespace palpate::testing
