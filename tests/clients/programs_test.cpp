// SPDX-License-Identifier: Apache-2.0
// What all client programs do, and palpate-watch, as processes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
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
