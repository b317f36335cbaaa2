// SPDX-License-Identifier: Apache-2.0
// palpate-solve as its user sees it: exit code, standard output, standard error, files.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <tuple>

#include "solved_block.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/read_mesh.h"

namespace palpate {
namespace {

TEST_F(SolveProgram, MakesAModelThatInspectReads) {
  const ProgramResult result =
      solve({writeCase("[model]\nmodes = 20\nnear_radius = 0.02\n"), "-o", path("out.h5"), "--json", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto summary = nlohmann::json::parse(result.out);
  EXPECT_EQ(summary.at("nodes"), 9 * 7 * 7);  // 5 x 4 x 4, raised to quadratic elements
  EXPECT_EQ(summary.at("modes"), 20);
  EXPECT_GT(summary.at("peak_memory_MiB"), 1.0);
  for (const char* key : {"factor", "series", "fit", "write", "total"})
    EXPECT_GE(summary.at("seconds").at(key), 0.0);
  EXPECT_TRUE(fs::exists(folder_ / "out.xdmf"));
  const ProgramResult inspect = runProgram("palpate-inspect", {path("out.h5"), "--json"});
  ASSERT_EQ(inspect.exit_code, 0) << inspect.err;
  const auto model = nlohmann::json::parse(inspect.out);
  EXPECT_EQ(summary.at("travel").at("travel"), 0.005) << "of 160 kPa";
  for (const char* key : {"order", "force_order"}) EXPECT_EQ(model.at(key), summary.at(key));
  for (const char* radius : {"domain_radius", "series_radius"})
    EXPECT_EQ(model.at(radius).at("p05"), summary.at(radius).at("p05"));
  EXPECT_GE(model.at("series_radius").at("p05"), model.at("domain_radius").at("p05"));
  EXPECT_NE(model.at("provenance").at("case").get<std::string>().find("modes = 20"), std::string::npos);
}

TEST_F(SolveProgram, RaisesALinearMeshOrNot) {
  const auto nodes = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", path("out.h5"), "-q", "--json", "--modes", "20"});
    const ProgramResult result = solve(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out).at("nodes").get<int>();
  };
  const std::string steady = "[material]\nnu = 0.3\n";
  EXPECT_EQ(nodes({path("block.msh"), "--element-order", "1"}), 80);
  EXPECT_EQ(nodes({writeCase(steady)}), 80) << "linear elements do not lock";
  EXPECT_EQ(nodes({writeCase(steady), "--element-order", "2"}), 441);
  EXPECT_EQ(nodes({path("block.msh"), "--method", "series-force"}), 80) << "the paper's";
  std::ofstream(folder_ / "case.toml") << "[mesh]\nfile = \"block.msh\"\nelement_order = 1\n";
  EXPECT_EQ(nodes({path("case.toml")}), 80);
}

TEST_F(SolveProgram, RefusesElementsThatThereAreNot) {
  std::ofstream(folder_ / "case.toml") << "[mesh]\nfile = \"block.msh\"\nelement_order = 3\n";
  expectRefusal(solve({path("case.toml"), "-o", path("out.h5")}), "case.toml:3: mesh.element_order");
  std::ofstream(folder_ / "case.toml") << "[mesh]\nelement_order = 2\n";
  expectRefusal(solve({path("case.toml"), "-o", path("out.h5")}), "mesh.file is missing");
  mesh::TetMesh block = mesh::quadraticOf(mesh::readMesh(folder_ / "block.msh"));
  block.groups.erase("organ");
  writeBlock("quadratic.msh", block);
  expectRefusal(solve({path("quadratic.msh"), "--element-order", "1", "-o", path("out.h5")}),
                "whose elements are quadratic");
}

TEST_F(SolveProgram, SaysHowStiffTheMeshIs) {
  const auto error = [&](const std::string& order) {
    const ProgramResult result = solve({path("block.msh"), "--element-order", order, "--mesh-error",
                                        "--modes", "20", "-o", path("out.h5"), "-q", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("mesh: too stiff by "), std::string::npos) << result.err;
    return nlohmann::json::parse(result.out).at("mesh_error");
  };
  const auto linear = error("1"), quadratic = error("2");
  EXPECT_EQ(linear.at("against"), "quadratic elements");
  EXPECT_EQ(quadratic.at("against"), "elements of half the size");
  EXPECT_EQ(linear.at("points"), 12);
  EXPECT_GT(linear.at("mean"), 0.1);
  EXPECT_LT(quadratic.at("mean"), 0.5 * linear.at("mean").get<double>());
  const auto file = nlohmann::json::parse(runProgram("palpate-inspect", {path("out.h5"), "--json"}).out);
  EXPECT_EQ(file.at("provenance").at("mesh_error"), quadratic);
  fs::remove(folder_ / "out.h5");
  expectRefusal(solve({path("block.msh"), "--mesh-error", "--method", "series-force", "-o", path("out.h5")}),
                "mesh.error has no effect");
}

TEST_F(SolveProgram, WarnsOfPatchesThatAreNarrowForTheMesh) {
  const std::string radius = "patch_radius = ";
  for (const auto& [key, order, narrow] : {std::tuple(radius + "0.008\n", "2", true),
                                           {radius + "0.014\n", "2", false},
                                           {radius + "0.014\n", "1", true},
                                           {"", "1", false},
                                           {"", "2", false}}) {
    const ProgramResult result = solve(
        {writeCase("[model]\nmodes = 20\n" + key), "--element-order", order, "-o", path("out.h5"), "-q"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("warning: a patch is") != std::string::npos, narrow) << key << order << '\n'
                                                                                   << result.err;
  }
}

TEST_F(SolveProgram, TakesMidSideNodesThatAFileHasRounded) {
  mesh::TetMesh block = mesh::quadraticOf(mesh::readMesh(folder_ / "block.msh"));
  block.groups.erase("organ");
  block.nodes[static_cast<std::size_t>(block.midsides[7][2])].y() += 2e-7;
  writeBlock("rounded.msh", block);
  const ProgramResult result = solve({path("rounded.msh"), "--modes", "20", "-o", path("out.h5"), "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(SolveProgram, SolvesABareMeshWithItsAccessibleGroup) {
  const ProgramResult result = solve({path("block.msh"), "-o", path("out.h5"), "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto model = nlohmann::json::parse(runProgram("palpate-inspect", {path("out.h5"), "--json"}).out);
  EXPECT_EQ(model.at("provenance").at("accessible"), "accessible");
  EXPECT_EQ(model.at("material").at("E"), 160e3);
}

TEST_F(SolveProgram, ComesOutTheSameEveryTime) {
  for (const char* name : {"one.h5", "two.h5"})
    ASSERT_EQ(solve({path("block.msh"), "-o", path(name), "-q", "--threads", "1"}).exit_code, 0);
  const auto id = [&](const char* name) {
    return nlohmann::json::parse(runProgram("palpate-inspect", {path(name), "--json"}).out).at("model_id");
  };
  EXPECT_EQ(id("one.h5"), id("two.h5"));
}

TEST_F(SolveProgram, RefusesAnUnknownKeyByLine) {
  expectRefusal(solve({writeCase("[material]\nyoung = 1\n"), "-o", path("out.h5")}),
                "case.toml:3: material.young");
}
TEST_F(SolveProgram, RefusesAMeshThatIsNotThere) {
  expectRefusal(solve({path("none.msh"), "-o", path("out.h5")}), "none.msh");
}
TEST_F(SolveProgram, RefusesAnUnknownGroupAndListsThoseThereAre) {
  const ProgramResult result = solve({writeCase("[boundary]\nfixed = \"rib\"\n"), "-o", path("out.h5")});
  expectRefusal(result, "no group \"rib\"");
  EXPECT_NE(result.err.find("accessible, fixed"), std::string::npos) << result.err;
}
TEST_F(SolveProgram, SpringsHoldAnOrganWithoutAClamp) {
  mesh::TetMesh block = mesh::makeBox({0.06, 0.05, 0.04}, {5, 4, 4});
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(block.nodes.size()); ++node)
    block.groups[block.nodes[static_cast<std::size_t>(node)].x() < 1e-9 ? "bed" : "accessible"].push_back(
        node);
  writeBlock("block.msh", block);
  expectRefusal(solve({path("block.msh"), "-o", path("out.h5")}), "no group \"fixed\"");
  const std::string springs = "[[spring]]\ngroup = \"bed\"\nstiffness = ";
  expectRefusal(solve({writeCase("[boundary]\nfixed = \"rib\"\n" + springs + "1e7\n"), "-o", path("out.h5")}),
                "no group \"rib\"");
  expectRefusal(solve({writeCase(springs + "1e-12\n"), "-o", path("out.h5"), "-q"}), "or by springs?");
  const ProgramResult result =
      solve({writeCase("[boundary]\naccessible = \"accessible\"\n" + springs + "1e7\n"), "-o", path("out.h5"),
             "-q", "--json", "--mesh-error"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto file = nlohmann::json::parse(runProgram("palpate-inspect", {path("out.h5"), "--json"}).out);
  EXPECT_NEAR(file.at("springs").at("stiffness"), 1e7 * 0.05 * 0.04, 1e-6);
  const ProgramResult query = runProgram(
      "palpate-query",
      {path("out.h5"), "--at", "0.06,0.025,0.02", "--displacement", "-0.001,0,0.0005", "--newton", "--json"});
  ASSERT_EQ(query.exit_code, 0) << query.err;
  const auto newton = nlohmann::json::parse(query.out).at("newton");
  EXPECT_LT(newton.at("force_error"), 0.01);
  EXPECT_LT(newton.at("field_error_max"), 0.02);
}
TEST_F(SolveProgram, RefusesAClampThatDoesNotHold) {
  mesh::TetMesh block = mesh::makeBox({0.06, 0.05, 0.04}, {5, 4, 4});
  block.groups["fixed"] = {0, 1};
  writeBlock("loose.msh", block);
  expectRefusal(solve({path("loose.msh"), "-o", path("out.h5")}), "loose.msh");
}
TEST_F(SolveProgram, RefusesAFolderThatIsNotThereBeforeItSolves) {
  expectRefusal(solve({path("block.msh"), "-o", path("nowhere/out.h5")}), "No such file or directory");
}
TEST_F(SolveProgram, RefusesAnOutputThatItsOwnXdmfWouldReplace) {
  expectRefusal(solve({path("block.msh"), "-o", path("out.xdmf")}), "--output");
}
TEST_F(SolveProgram, RefusesAPatchThatReachesNoNeighbour) {
  expectRefusal(solve({writeCase("[model]\npatch_radius = 1e-6\n"), "-o", path("out.h5")}),
                "model.patch_radius = 1e-06 m");
}
TEST_F(SolveProgram, RefusesAPatchAsWideAsTheOrgan) {
  expectRefusal(solve({writeCase("[model]\npatch_radius = 0.5\n"), "-o", path("out.h5")}),
                "model.patch_radius = 0.5 m");
}
TEST_F(SolveProgram, RefusesAnUnknownOption) {
  expectRefusal(solve({path("block.msh"), "--bogus"}), "--bogus");
}
TEST_F(SolveProgram, TellsABadFileFromACommandLineThatCannotBeUsed) {
  const auto code = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), path("block.msh"));
    return solve(arguments).exit_code;
  };
  EXPECT_EQ(code({"-o", path("nowhere/out.h5")}), 2);
  EXPECT_EQ(code({"-o", path("nowhere/case.toml"), "--template"}), 2);
  EXPECT_EQ(code({"-o", folder_.path().string()}), 2) << "a folder";
  EXPECT_EQ(code({"-o", path("out.xdmf")}), 2);
  EXPECT_EQ(code({"-o", path("block.msh"), "--template"}), 2) << "it would replace the mesh";
  EXPECT_EQ(code({"-o", path("out.h5"), "--method", "pod"}), 2);
  EXPECT_EQ(code({"-o", path("out.h5"), "--travel", "0.01", "--order", "3"}), 2);
  EXPECT_EQ(code({"-o", path("out.h5"), "--size-limit", "8e6"}), 2) << "without --target handheld";
  EXPECT_EQ(solve({path("none.msh"), "-o", path("out.h5")}).exit_code, 1);
  EXPECT_EQ(solve({writeCase("[material]\nyoung = 1\n"), "-o", path("out.h5")}).exit_code, 1);
}
TEST_F(SolveProgram, TakesAPathThatIsNotUtf8) {
  const std::string odd = path("caf\xe9.msh");
  fs::copy(folder_ / "block.msh", odd);
  const ProgramResult result = solve({odd, "-o", path("caf\xe9.h5"), "-q", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

}  // namespace
}  // namespace palpate
