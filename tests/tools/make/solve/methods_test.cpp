// SPDX-License-Identifier: Apache-2.0
// palpate-solve --method as its user sees it: one small block, every method, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/topology.h"
#include "tools/mesh/write_msh.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ProgramResult;
using testing::runProgram;

class SolveMethods : public ::testing::Test {
 protected:
  SolveMethods() {
    mesh::TetMesh block = mesh::makeBox({0.06, 0.05, 0.04}, {5, 4, 4});
    const mesh::BoundarySurface boundary = mesh::boundaryOf(block);
    for (const std::int32_t node : boundary.nodes)
      block.groups[block.nodes[static_cast<std::size_t>(node)].x() < 1e-9 ? "fixed" : "accessible"].push_back(
          node);
    mesh::writeMsh(folder_ / "block.msh", block, boundary);
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] ProgramResult solve(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{path("block.msh"), "-o", path("out.h5"), "-q", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("palpate-solve", arguments);
  }
  [[nodiscard]] json solved(const std::vector<std::string>& more) const {
    const ProgramResult result = solve(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? json::parse(result.out) : json();
  }
  [[nodiscard]] json inspected() const {
    const ProgramResult result = runProgram("palpate-inspect", {path("out.h5"), "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out);
  }
  void expectRefusal(const std::vector<std::string>& more, const std::string& part) const {
    const ProgramResult result = solve(more);
    EXPECT_GT(result.exit_code, 0);
    EXPECT_TRUE(result.out.empty()) << result.out;
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(folder_ / "out.h5"));
  }

  const testing::TemporaryFolder folder_;
};

TEST_F(SolveMethods, EveryMethodSolvesABareMesh) {
  const std::map<std::string, std::string> kinds{{"series-displacement", "displacement"},
                                                 {"series-force", "force"},
                                                 {"pgd-linear", "level"},
                                                 {"pgd-explicit", "level"},
                                                 {"pgd-euler", "level"}};
  for (const auto& [method, kind] : kinds) {
    const json summary = solved({"--method", method, "--modes", "40"});
    EXPECT_EQ(summary.at("method"), method);
    EXPECT_EQ(summary.at("parameters"), kind);
    if (method.starts_with("series")) {
      EXPECT_EQ(summary.at("modes"), 40);
    } else {  // fewer pairs than were allowed only where the residual asks for no more
      EXPECT_EQ(summary.at("modes"), std::min(40, summary.at("pairs").get<int>())) << method;
      EXPECT_LE(summary.at("residual"), method == "pgd-linear" ? 1e-3 : 0.1) << method;
    }
    EXPECT_TRUE(fs::exists(folder_ / "out.xdmf"));
    const json model = inspected();
    EXPECT_EQ(model.at("parameters"), kind);
    EXPECT_EQ(model.at("provenance").at("method"), method);
    const std::string radius = kind == "displacement" ? "domain_radius" : kind + "_radius";
    EXPECT_EQ(model.at(radius).at("median"), summary.at(radius).at("median")) << method;
    fs::remove(folder_ / "out.h5");
  }
}

TEST_F(SolveMethods, TheLoadIsWhatTheCommandLineSays) {
  const json summary = solved({"--method", "pgd-explicit", "--modes", "30", "--load-direction", "0,3,-4",
                               "--load", "0.25", "--steps", "5"});
  EXPECT_EQ(summary.at("load").at("magnitude"), 0.25);
  EXPECT_EQ(summary.at("load").at("steps"), 5);
  EXPECT_NEAR(summary.at("load").at("direction").at(2), -0.8, 1e-15);
  EXPECT_GT(summary.at("pairs"), 0);
  const json load = inspected().at("load");
  EXPECT_EQ(load.dump().find("null"), std::string::npos) << load;
}

TEST_F(SolveMethods, ATruncatedLoadSaysWhatItLeavesOut) {
  std::ofstream(folder_ / "case.toml")
      << "mesh = \"block.msh\"\n[model]\nmethod = \"pgd-linear\"\nmodes = 20\n[load]\ntruncation = 12\n";
  const ProgramResult result =
      runProgram("palpate-solve", {path("case.toml"), "-o", path("out.h5"), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json load = json::parse(result.out).at("load");
  EXPECT_EQ(load.at("truncation"), 12);
  EXPECT_GT(load.at("truncation_error"), 0.0);
  EXPECT_LT(load.at("truncation_error"), 1.0);
  EXPECT_EQ(inspected().at("provenance").at("load"), load);
  EXPECT_NE(result.err.find("load of 12 terms"), std::string::npos) << result.err;
  EXPECT_EQ(solved({"--method", "pgd-linear", "--modes", "20"}).at("load").at("truncation_error"), 0.0);
}

TEST_F(SolveMethods, TheCommandLineOverridesTheCaseFile) {
  std::ofstream(folder_ / "case.toml")
      << "mesh = \"block.msh\"\n[model]\nmethod = \"series-force\"\nmodes = 50\n"
         "order = 4\n";
  const ProgramResult result = runProgram("palpate-solve", {path("case.toml"), "-o", path("out.h5"), "-q",
                                                            "--json", "--modes", "25", "--order", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json summary = json::parse(result.out);
  EXPECT_EQ(summary.at("method"), "series-force");
  EXPECT_EQ(summary.at("modes"), 25);
  EXPECT_EQ(summary.at("order"), 2);
}

TEST_F(SolveMethods, TheCommandLineNamesTheLaw) {
  (void)solved({"--method", "pgd-linear", "--modes", "5", "--law", "stable-neo-hookean"});
  EXPECT_EQ(inspected().at("material").at("law"), "stable-neo-hookean");
}

TEST_F(SolveMethods, ThreeDirectionsMakeALinearFunctionOfTheForce) {
  const json summary = solved({"--method", "pgd-linear", "--modes", "60", "--load-direction", "any"});
  EXPECT_EQ(summary.at("parameters"), "force");
  EXPECT_EQ(summary.at("order"), 1);
  EXPECT_EQ(summary.at("load").at("direction"), "any");
}

TEST_F(SolveMethods, RefusesALawThatThereIsNot) {
  expectRefusal({"--law", "jelly"}, "--law = \"jelly\" is not known (known: stvk, stable-neo-hookean)");
}
TEST_F(SolveMethods, RefusesAMethodThatThereIsNot) {
  expectRefusal({"--method", "pod"}, "--method = \"pod\" is not known (known: series-displacement");
}
TEST_F(SolveMethods, RefusesAnOrderOfAPgd) {
  expectRefusal({"--method", "pgd-linear", "--order", "3"},
                "model.order has no effect with method pgd-linear");
}
TEST_F(SolveMethods, RefusesStepsOfASeries) {
  expectRefusal({"--steps", "30"}, "load.steps has no effect with method series-displacement");
}
TEST_F(SolveMethods, RefusesADirectionOfASeries) {
  expectRefusal({"--method", "series-force", "--load-direction", "0,0,1"}, "load.direction has no effect");
}
TEST_F(SolveMethods, RefusesALoadOfASeries) {
  expectRefusal({"--method", "series-force", "--load", "2"}, "load.magnitude has no effect");
}
TEST_F(SolveMethods, PointsFromANonlinearPgdOfAnyDirectionToTheForceSeries) {
  expectRefusal({"--method", "pgd-explicit", "--load-direction", "any"}, "method series-force");
}
TEST_F(SolveMethods, RefusesAMalformedDirection) {
  for (const char* direction : {"0,0,0", "1,2", "up", "1,2,3,4", "nan,0,1"})
    expectRefusal({"--method", "pgd-linear", "--load-direction", direction}, "--load-direction");
}
TEST_F(SolveMethods, RefusesANegativeLoad) {
  expectRefusal({"--method", "pgd-linear", "--load", "-1"}, "--load");
}
TEST_F(SolveMethods, NamesTheCaseFileWhoseKeysDoNotFitTheMethod) {
  std::ofstream(folder_ / "case.toml") << "mesh = \"block.msh\"\n[model]\nnear_radius = 0.02\n";
  const ProgramResult result =
      runProgram("palpate-solve", {path("case.toml"), "-o", path("out.h5"), "--method", "series-force"});
  EXPECT_GT(result.exit_code, 0);
  EXPECT_NE(result.err.find("case.toml: model.near_radius has no effect with method series-force"),
            std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace palpate
