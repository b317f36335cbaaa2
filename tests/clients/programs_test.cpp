// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "fake_server.h"
#include "palpate/testing/child_process.h"
#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"
#include "palpate/testing/test_domain.h"
#include "palpate/testing/xml_fault.h"

namespace palpate::testing {
namespace {

using nlohmann::json;

std::vector<std::string> onDomain(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--domain", std::to_string(exclusiveDomain())});
  return arguments;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(Programs, HaveHelpAndAVersion) {
  for (const char* program : {"palpate-tool", "palpate-latency", "palpate-watch", "palpate-device"}) {
    const auto help = runProgram(program, {"--help"});
    EXPECT_EQ(help.exit_code, 0) << program;
    EXPECT_NE(help.out.find("--domain"), std::string::npos) << program;
    EXPECT_EQ(runProgram(program, {"--version"}).exit_code, 0) << program;
  }
}

TEST(Programs, SayWhatTheyWaitForWhenThereIsNoServer) {
  for (const char* program : {"palpate-tool", "palpate-latency", "palpate-watch", "palpate-device"}) {
    const auto result = runProgram(program, onDomain({"--wait", "0.3", "--json"}));
    EXPECT_EQ(result.exit_code, 1) << program;
    EXPECT_EQ(result.out, "") << program;
    EXPECT_NE(result.err.find(std::string(program) + ": no server on DDS domain " +
                              std::to_string(exclusiveDomain()) + " within 0.30 s"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(lines(result.err), 2U) << result.err;  // what it waits for, and that it did not come
  }
}

TEST(Programs, ParametersWaitsAsTheOthersDo) {
  const auto result = runProgram("palpate-parameters", onDomain({"--wait", "0.3"}));
  const std::string domain = "DDS domain " + std::to_string(exclusiveDomain());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err,
            "waiting for server 0 on " + domain + "\npalpate-parameters: no server 0 answered on " + domain +
                " within 0.30 s; is palpate-server running there, and does CYCLONEDDS_URI name the same "
                "network?\n");
}

TEST(Programs, RefuseBadOptionsByName) {
  const auto script = runProgram("palpate-tool", {"--script", "dance"});
  EXPECT_EQ(script.exit_code, 2);
  EXPECT_NE(script.err.find("--script"), std::string::npos);
  const auto depth = runProgram("palpate-tool", {"--depth", "5"});
  EXPECT_EQ(depth.exit_code, 2);
  EXPECT_EQ(depth.err,
            "palpate-tool: --depth: 5 is out of range, expected 1e-06 to 0.05 m (--help tells more)\n");
  const auto dept = runProgram("palpate-tool", {"--dept", "0.003"});
  EXPECT_EQ(dept.exit_code, 2);
  EXPECT_EQ(dept.err, "palpate-tool: unknown option --dept: did you mean --depth?\n");
  const auto at = runProgram("palpate-latency", {"--at", "1,2"});
  EXPECT_EQ(at.exit_code, 2);
  EXPECT_EQ(at.err, "palpate-latency: --at is '1,2', expected three finite numbers x,y,z\n");
  const auto hand = runProgram("palpate-device", {"--hand", "0.1,2,0"});
  EXPECT_EQ(hand.exit_code, 2);
  EXPECT_EQ(hand.err, "palpate-device: --hand: hand stiffness (N/m) is 0, expected 1 to 100000\n");
  const auto seconds = runProgram("palpate-device", {"--motion", "drag", "--seconds", "2"});
  EXPECT_EQ(seconds.exit_code, 2);
  EXPECT_EQ(seconds.err, "palpate-device: --seconds is 2, expected 3.2 to 3600\n");
  const auto loose = runProgram("palpate-device", {"--friction", "10", "--hand", "0.1,2,1"});
  EXPECT_EQ(loose.exit_code, 2);
  EXPECT_EQ(loose.err,
            "palpate-device: --friction by the stiffness of --hand is 10 m, by which the hand would lead the "
            "device, expected at most 0.2 m\n");
  const auto preset = runProgram("palpate-device", {"--preset", "falcon"});
  EXPECT_EQ(preset.exit_code, 2);
  EXPECT_NE(preset.err.find("--preset"), std::string::npos);
  const auto vtk = runProgram("palpate-watch", {"--vtk", "field.stl"});
  EXPECT_EQ(vtk.exit_code, 2);
  EXPECT_EQ(vtk.err,
            "palpate-watch: --vtk: cannot write field.stl: expected a name that ends in .vtu or .vtk\n");
}

// --wait is long: a program that looked for a server first would not end in time.
TEST(Programs, RefuseAPlaceThatCannotBeWrittenBeforeTheyLookForAServer) {
  const TemporaryFolder folder;
  const auto refused = [&](const char* program, const std::string& option,
                           const std::filesystem::path& place) {
    const auto result = runProgram(program, onDomain({option, place.string(), "--wait", "3600"}));
    EXPECT_EQ(result.exit_code, 2) << program;
    return result.err;
  };
  for (const char* program : {"palpate-tool", "palpate-latency", "palpate-device"}) {
    EXPECT_EQ(
        refused(program, "--plot", "/nonexistent/x.svg"),
        std::string(program) + ": --plot: cannot write /nonexistent/x.svg: No such file or directory\n");
    EXPECT_EQ(refused(program, "--plot", folder.path()), std::string(program) + ": --plot: cannot write " +
                                                             folder.path().string() + ": Is a directory\n");
  }
  EXPECT_EQ(refused("palpate-watch", "--vtk", "/nonexistent/x.vtu"),
            "palpate-watch: --vtk: cannot write /nonexistent/x.vtu: No such file or directory\n");
}

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

TEST(Programs, RefuseAPlaceOffTheOrganAndSuspectTheUnit) {
  const FakeServer server(exclusiveDomain(), {});
  for (const char* program : {"palpate-tool", "palpate-latency", "palpate-device"}) {
    const auto far = runProgram(program, onDomain({"--at", "9,9,9"}));
    EXPECT_EQ(far.exit_code, 2) << program;
    EXPECT_EQ(far.out, "") << program;
    EXPECT_NE(far.err.find(": --at 9,9,9 m lies 15.47 m from the organ's surface, expected at most 6 mm"),
              std::string::npos)
        << far.err;
    const auto slip = runProgram(program, onDomain({"--at", "50,50,52"}));
    EXPECT_EQ(slip.exit_code, 2) << program;
    EXPECT_NE(slip.err.find("in millimetres it would lie 2 mm from the organ's surface: give metres"),
              std::string::npos)
        << slip.err;
  }
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

// Against a spring the hand's and the organ's stiffness share the depth.
TEST(Device, PressRestsWhereHandAndOrganBalance) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 300.0, .tip_radius = 0.004});
  const TemporaryFile svg("device.svg");
  const auto result =
      runProgram("palpate-device", onDomain({"--preset", "premium15", "--hand", "0.1,3,200", "--motion",
                                             "press", "--seconds", "2.5", "--json", "--plot", svg.path()}));
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
  const auto result =
      runProgram("palpate-device", onDomain({"--preset", "custom", "--mass", "0.05", "--hand", "0.02,0.5,50",
                                             "--motion", "press", "--seconds", "2.5", "--json"}));
  ASSERT_EQ(result.exit_code, 3) << result.err;
  const json report = json::parse(result.out);
  EXPECT_FALSE(report["stable"]);
  EXPECT_GT(report["oscillation_pp_m"].get<double>(),
            2.0 * report["oscillation_without_organ_pp_m"].get<double>());
  EXPECT_LT(report["energy_net_J"].get<double>(), 0.0) << "and gives energy that nobody put in";
}

// A contact in which the machine stood still tells nothing of the loop: taps until one run has another kind.
// @return that run, or nothing where there was none
std::optional<ProgramResult> tapThatCounts(std::vector<std::string> more) {
  more.insert(more.end(), {"--motion", "tap", "--seconds", "2.5", "--json"});
  for (int i = 0; i < 5; ++i) {
    ProgramResult result = runProgram("palpate-device", onDomain(more));
    if (result.exit_code == 1) continue;  // stood still for a second
    const json contacts = json::parse(result.out)["energy"]["contacts"];
    if (std::any_of(contacts.begin(), contacts.end(),
                    [](const json& one) { return one["stalled"] == false; }))
      return result;
  }
  return std::nullopt;
}
constexpr const char* kMachineStoodStill = "the machine stood still in every tap of five runs";

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

// Stiff enough that 40 ms without an answer, felt, would throw the tip off; soft enough to stand answers that are always
// a period late, as a busy machine gives them.
TEST(Device, AStallOfTheServerIsWaitedForAndNotFelt) {
  const FakeServer server(exclusiveDomain(), {.stiffness = 500.0, .stall_every = 150});
  const auto result = runProgram(
      "palpate-device",
      onDomain({"--preset", "custom", "--mass", "0.05", "--motion", "press", "--seconds", "2.5", "--json"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_GE(report["waited_periods"].get<int>(), 200) << "some ten stalls";
  EXPECT_TRUE(report["stable"]);
  EXPECT_EQ(report["tip_m"].size(), 2501U);
  EXPECT_NEAR(report["penetration_m"].get<double>(), 0.003 * 200.0 / 700.0, 1e-4);
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
}

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

TEST(Watch, SeesTheOrganMove) {
  const FakeServer server(exclusiveDomain(), {});
  // The tool runs in the background of the watch: the fields flow only while poses come.
  std::thread tool([] {
    const auto pressed = runProgram("palpate-tool", onDomain({"--script", "press", "--seconds", "2"}));
    EXPECT_EQ(pressed.exit_code, 0) << pressed.err;
  });
  const TemporaryFile vtu("watch.vtu");
  const auto result =
      runProgram("palpate-watch", onDomain({"--seconds", "2.5", "--json", "--vtk", vtu.path()}));
  tool.join();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report["surface_nodes"], 5);
  EXPECT_EQ(report["peak"]["node"], 15);
  EXPECT_NEAR(report["peak"]["size"].get<double>(), 0.003, 1e-6);
  EXPECT_NEAR(report["peak"]["displacement"][2].get<double>(), -0.003, 1e-6);
  EXPECT_EQ(xmlFault(contentOf(vtu.path())), "");
}

}  // namespace
}  // namespace palpate::testing
