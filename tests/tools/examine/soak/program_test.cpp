// SPDX-License-Identifier: Apache-2.0
// tools/soak as a whole, for seconds, against real programs on synthetic models.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "palpate/testing/paths.h"
#include "palpate/testing/run_program.h"
#include "palpate/testing/synthetic_model.h"

namespace palpate::testing {

namespace {

using ::testing::HasSubstr;

const std::string kSoak = std::string(PALPATE_TOOLS_DIR) + "/soak";

// Whether only lines through the ends of scenes do not hold: with much other work there are too few ends, or two that differ. What
// leaks does so in a longer run too; a server that ends, or loses answers, is none.
bool wantsALongerRun(const std::string& said) {
  const auto json = nlohmann::json::parse(said, nullptr, false);
  if (!json.is_object()) return false;
  for (const nlohmann::json& verdict : json["verdicts"]) {
    const auto what = verdict["what"].get<std::string>();
    const bool is_line = what.find(' ') != std::string::npos || what == "scenes";  // "server memory"
    if (!verdict["holds"].get<bool>() && !is_line) return false;
  }
  return true;
}

}  // namespace

TEST(Soak, JudgesAServerAmongToolsVisitorsChangesAndAHostileClient) {
  const TemporaryFile model("soaked.h5"), other("other.h5");
  const TemporaryFolder out;
  writeSyntheticModel(model.path(), {.subdivisions = 2, .modes = 6});
  writeSyntheticModel(other.path(), {.subdivisions = 2, .modes = 6, .stiffness = 200.0});
  ProgramResult made;
  std::string table;
  std::filesystem::path folder;
  for (const std::string minutes : {"0.33", "0.7", "1.5"}) {
    folder = out.path() / minutes;
    made = runProgram(kSoak, {"--minutes", minutes, "--bin", binDir(), "--model", model.path().string(),
                              "--swap", other.path().string(), "--output", folder.string(), "--json"});
    table = contentOf(folder / "soak.txt");
    if (made.exit_code == 0 || !wantsALongerRun(made.out)) break;
  }
  EXPECT_EQ(made.exit_code, 0) << made.out << made.err << table;
  const auto json = nlohmann::json::parse(made.out);
  EXPECT_EQ(json["verdicts"].size(), 11U);
  EXPECT_GE(json["scenes"], 2);
  for (const char* key : {"visitors", "pages", "frames", "asked", "accepted", "swaps", "wrong"})
    EXPECT_GT(json["counts"][key], 0) << key;
  for (const nlohmann::json& row : json["rows"]) {
    EXPECT_GT(row["server"]["rss"], 10.0);
    EXPECT_GT(row["viewer"]["descriptors"], 3);
    EXPECT_GT(row["pose_to_force_us"]["p99"], row["pose_to_force_us"]["p50"]);
    EXPECT_GT(row["ticks"], 1000);
  }
  EXPECT_THAT(table, HasSubstr("holds   server memory"));
  if (isInstalled("gnuplot")) {
    EXPECT_THAT(contentOf(folder / "soak.svg"), HasSubstr("</svg>"));
  }
}

TEST(Soak, SimulatesTimeWithoutAServer) {
  const TemporaryFile model("hours.h5");
  writeSyntheticModel(model.path());
  const ProgramResult made = runProgram(
      kSoak, {"--simulated", "0.005", "--bin", binDir(), "--model", model.path().string(), "--json"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const auto json = nlohmann::json::parse(made.out);
  EXPECT_EQ(json["holds"], true);
  EXPECT_GT(json["rows"][0]["in_contact"], 1000);
}

}  // namespace palpate::testing
