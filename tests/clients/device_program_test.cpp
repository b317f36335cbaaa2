// SPDX-License-Identifier: Apache-2.0
// palpate-device as a process, against a small server inside the test.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fake_server.h"
#include "on_domain.h"
#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"
#include "palpate/testing/test_domain.h"
#include "palpate/testing/xml_fault.h"
#include "stood_still.h"

namespace palpate::testing {
namespace {

using nlohmann::json;

constexpr const char* kMachineStoodStill = "the machine stood still in each of five runs";

// A run in which the machine stood still too often tells nothing of the loop: again until one counts.
// @return that run, or nothing where there was none
std::optional<ProgramResult> runThatCounts(std::vector<std::string> arguments) {
  arguments.push_back("--json");
  for (int i = 0; i < 5; ++i) {
    ProgramResult result = runProgram("palpate-device", onDomain(arguments));
    if (!stoodStill(result)) return result;
  }
  return std::nullopt;
}

// A contact in which the machine stood still tells nothing of the loop: taps until one run has another kind.
// @return that run, or nothing where there was none
std::optional<ProgramResult> tapThatCounts(std::vector<std::string> more) {
  more.insert(more.end(), {"--motion", "tap", "--seconds", "2.5", "--json"});
  for (int i = 0; i < 5; ++i) {
    ProgramResult result = runProgram("palpate-device", onDomain(more));
    if (stoodStill(result)) continue;
    const json contacts = json::parse(result.out)["energy"]["contacts"];
    if (std::any_of(contacts.begin(), contacts.end(),
                    [](const json& one) { return one["stalled"] == false; }))
      return result;
  }
  return std::nullopt;
}

// Against a spring the hand's and the organ's stiffness share the depth.
TEST(Device, PressRestsWhereHandAndOrganBalance) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 300.0, .tip_radius = 0.004});
  const TemporaryFile svg("device.svg");
  const auto run = runThatCounts({"--preset", "premium15", "--hand", "0.1,3,200", "--motion", "press",
                                  "--seconds", "2.5", "--plot", svg.path()});
  if (!run) GTEST_SKIP() << kMachineStoodStill;
  const auto& result = *run;
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report["device"]["mass"], 0.075);
  EXPECT_TRUE(report["stable"]);
  EXPECT_LT(report["settle_s"].get<double>(), 1.0);
  const double rest = 0.054 - report["tip_m"][2000][2].get<double>();
  EXPECT_NEAR(rest, 0.003 * 200.0 / 500.0, 2e-4) << "Coulomb friction holds it up to 0.04 N / 500 N/m away";
  EXPECT_GE(report["penetration_m"].get<double>(), rest);
  EXPECT_NEAR(report["max_force_N"].get<double>(), 300.0 * report["penetration_m"].get<double>(), 1e-3);
  EXPECT_EQ(report["flags"], 1) << "contact, and nothing else";
  EXPECT_NEAR(report["energy_net_J"].get<double>(), 0.0, 5e-5) << "a spring gives back what it took";
  EXPECT_EQ(xmlFault(contentOf(svg.path())), "");
}

TEST(Device, AWallThatIsTooStiffForItsHandIsCalledUnstable) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 8000.0});
  const auto run = runThatCounts({"--preset", "custom", "--mass", "0.05", "--hand", "0.02,0.5,50", "--motion",
                                  "press", "--seconds", "2.5"});
  if (!run) GTEST_SKIP() << kMachineStoodStill;
  const auto& result = *run;
  ASSERT_EQ(result.exit_code, 3) << result.err;
  const json report = json::parse(result.out);
  EXPECT_FALSE(report["stable"]);
  if (report["judged_s"].get<double>() > 0.0) {  // else its contacts alone show it
    EXPECT_GT(report["oscillation_pp_m"].get<double>(),
              2.0 * report["oscillation_without_organ_pp_m"].get<double>());
  }
  EXPECT_LT(report["energy_net_J"].get<double>(), 0.0) << "and gives energy that nobody put in";
}

// A spring k that answers a period later gives k 1.5 ms v^2, as a damping of -0.45 N s/m; hand and device have 2.
TEST(Device, ATapIsJudgedByTheEnergyThatItsLagGives) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 300.0});
  const auto run = tapThatCounts({"--preset", "custom", "--mass", "0.05"});
  if (!run) GTEST_SKIP() << kMachineStoodStill;
  const auto& result = *run;
  const json report = json::parse(result.out);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(report["stable"]);
  EXPECT_TRUE(report["energy"]["holds"]);
  EXPECT_GE(report["energy"]["contacts"].size(), 4U) << "three taps and the hold";
  EXPECT_GT(report["energy"]["given_J"].get<double>(), 0.0);
  EXPECT_LT(report["energy"]["given_J"].get<double>(), 0.5 * report["energy"]["damped_J"].get<double>());
  EXPECT_NE(result.err.find("as a damping of -0."), std::string::npos) << result.err;
}

TEST(Device, ATapOnAWallThatGivesMoreThanIsDampedIsUnstable) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 2000.0});
  const auto run = tapThatCounts({"--preset", "custom", "--mass", "0.05", "--hand", "0.02,0.5,50"});
  if (!run) GTEST_SKIP() << kMachineStoodStill;
  const auto& result = *run;
  ASSERT_EQ(result.exit_code, 3) << result.err;
  const json report = json::parse(result.out);
  EXPECT_FALSE(report["energy"]["holds"]);
  EXPECT_FALSE(report["stable"]);
  EXPECT_NE(result.err.find("more than was damped"), std::string::npos) << result.err;
}

// Stiff enough that 40 ms without an answer, felt, would throw the tip off. The server stalls from time to time: what lies between
// is judged.
TEST(Device, AStallOfTheServerIsWaitedForAndNotFelt) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 500.0, .stall_every = 1500});
  const auto run =
      runThatCounts({"--preset", "custom", "--mass", "0.05", "--motion", "press", "--seconds", "6"});
  if (!run) GTEST_SKIP() << kMachineStoodStill;
  EXPECT_EQ(run->exit_code, 0) << run->err;
  const json report = json::parse(run->out);
  EXPECT_GE(report["waited_periods"].get<int>(), 100) << "at least three stalls";
  EXPECT_TRUE(report["stable"]);
  EXPECT_LT(report["judged_s"].get<double>(), 3.5) << "the stalls take their 0.5 s each";
  EXPECT_EQ(report["tip_m"].size(), 6001U);
  EXPECT_NEAR(report["penetration_m"].get<double>(), 0.003 * 200.0 / 700.0, 1e-4);
}

// A damper goes on by its own clock while the device stands still, so a loop that it holds is not the same one after stalls.
TEST(Device, AHoldFullOfStallsIsNotJudgedWhereADamperFeelsThem) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 500.0, .damping_s = 2e-3, .stall_every = 150});
  const auto result = runProgram(
      "palpate-device",
      onDomain({"--preset", "custom", "--mass", "0.05", "--motion", "press", "--seconds", "2.5", "--json"}));
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const json report = json::parse(result.out);
  EXPECT_FALSE(report["judged"]);
  EXPECT_FALSE(report["stable"]);
  EXPECT_GE(report["waited_periods"].get<int>(), 200) << "some ten stalls";
  EXPECT_NE(result.err.find("stood still too often: not judged"), std::string::npos) << result.err;
}

TEST(Device, ARunWithoutAContactIsNotJudged) {
  const FakeServer server(exclusiveDomain(), {.far = true});
  const auto result = runProgram(
      "palpate-device", onDomain({"--preset", "custom", "--motion", "press", "--seconds", "2.5", "--json"}));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_FALSE(json::parse(result.out)["stable"]) << "nothing is known of the loop";
  EXPECT_NE(result.err.find("no contact, so not judged"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("palpate-device: the tool never touched the organ"), std::string::npos)
      << result.err;
}

TEST(Device, StopsWhenTheServerLeaves) {
  const FakeServer server(exclusiveDomain(), {.leave_after = 200});
  const auto result = runProgram("palpate-device", onDomain({"--seconds", "60", "--json"}));
  ASSERT_EQ(result.exit_code, 1) << result.err;
  const json report = json::parse(result.out);
  EXPECT_TRUE(report["server_left"]);
  EXPECT_FALSE(report["stable"]) << "what was not seen to the end is not called stable";
  EXPECT_FALSE(report["judged"]) << "nor unstable";
}

TEST(Device, RefusesWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const FakeServerOptions& wrong :
       {FakeServerOptions{.wrong_force = kNan}, {.wrong_penetration = kNan}}) {
    const FakeServer server(exclusiveDomain(), wrong);
    const auto result = runProgram("palpate-device", onDomain({"--seconds", "2"}));
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("a force or a penetration that is not finite"), std::string::npos)
        << result.err;
  }
}

TEST(Device, OutlivesWildStamps) {
  const FakeServer server(exclusiveDomain(), {.wild_stamps = true});
  const auto result = runProgram("palpate-device", onDomain({"--seconds", "2", "--json"}));
  EXPECT_TRUE(result.exit_code == 0 || stoodStill(result)) << result.exit_code << result.err;
}

}  // namespace
}  // namespace palpate::testing
