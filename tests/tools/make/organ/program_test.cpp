// SPDX-License-Identifier: Apache-2.0
// palpate-organ as its user sees it: exit code, standard output, standard error.
#include <nlohmann/json.hpp>
#include <sstream>

#include "helpers.h"
#include "palpate/testing/paths.h"
#include "palpate/testing/run_program.h"
#include "samples.h"
#include "spoiled_sphere.h"
#include "tools/mesh/read_mesh.h"

namespace palpate::organ::test {
namespace {

using mesh::test::TemporaryFolder;
using palpate::testing::expectOneLineError;
using palpate::testing::ProgramResult;

ProgramResult run(const std::vector<std::string>& arguments) {
  return palpate::testing::runProgram("palpate-organ", arguments);
}

TEST(Program, WritesTheBeamAndTellsInJson) {
  const TemporaryFolder folder;
  const auto file = folder / "beam.msh";
  const ProgramResult result = run({"beam", "--json", "-o", file.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("nodes"), 1701);
  EXPECT_EQ(json.at("tetrahedra"), 7680);
  EXPECT_EQ(json.at("element_order"), 1);
  EXPECT_EQ(json.at("corners"), 1701);
  EXPECT_TRUE(json.at("regions").empty());
  EXPECT_EQ(json.at("fixed_nodes"), 81);
  EXPECT_EQ(json.at("accessible_nodes"), 689);
  EXPECT_NEAR(json.at("volume"), 0.00064, 1e-15);
  EXPECT_TRUE(json.at("warnings").empty());
  EXPECT_EQ(mesh::readMesh(file).groups.at("fixed").size(), 81U);
}

TEST(Program, JsonIsUtf8WhateverTheNamesAre) {
  const TemporaryFolder folder;
  std::string text = mesh::test::kMsh2;
  text.replace(text.find("lower face"), 5, "l\xff\xfew");
  const auto file = folder.write("a.msh", text);
  const ProgramResult result = run({"import", "--json", file.string(), "-o", (folder / "b.msh").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(nlohmann::json::accept(result.out)) << result.out;
}

TEST(Program, WritesALiverWithoutNoise) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run({"paper-liver", "--element-size", "0.015", "-o", (folder / "liver.msh").string()});
  EXPECT_EQ(result.exit_code, 0);
  std::istringstream err(result.err);  // on a slow machine it tells how far it is
  for (std::string line; std::getline(err, line);) EXPECT_TRUE(line.starts_with("progress  ")) << result.err;
  EXPECT_EQ(result.out.find("Info"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("worst quality"), std::string::npos) << result.out;
}

TEST(Program, WritesTheDefaultOrganWithItsCase) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "cases");
  const auto file = folder / "coarse.msh";
  const auto case_file = folder / "cases/soft.toml";
  const ProgramResult result = run({"liver", "--element-size", "0.02", "--inner-size", "0.03", "--json",
                                    "--case", case_file.string(), "-o", file.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("element_order"), 2);
  EXPECT_LT(4 * json.at("corners").get<int>(), json.at("nodes").get<int>());
  EXPECT_LT(3 * json.at("surface_corners").get<int>(), json.at("surface_nodes").get<int>());
  const mesh::TetMesh mesh = mesh::readMesh(file);
  EXPECT_TRUE(mesh.isQuadratic());
  for (const char* region : {"liver", "nodule"})
    EXPECT_EQ(json.at("regions").at(region).at("tetrahedra").get<std::size_t>(),
              mesh.regions.at(region).size());
  const std::string text = mesh::test::contentOf(case_file);
  EXPECT_TRUE(text.starts_with("[mesh]\nfile = '../coarse.msh'\n")) << text;
  EXPECT_NE(text.find("group = \"nodule\""), std::string::npos);
  expectOneLineError(run({"liver", "-o", file.string(), "--case", (folder / "none/a.toml").string()}),
                     "cannot write");
}

TEST(Program, PaperLiverCanBeRaised) {
  const TemporaryFolder folder;
  const ProgramResult result = run(
      {"paper-liver", "--element-size", "0.02", "--element-order", "2", "-o", (folder / "a.msh").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("of ten nodes"), std::string::npos) << result.out;
  EXPECT_TRUE(mesh::readMesh(folder / "a.msh").isQuadratic());
}

TEST(Program, RepairsAScanInMillimetresAndSaysWhatItChanged) {
  const TemporaryFolder folder;
  const std::string scan = (folder / "scan.stl").string(), organ = (folder / "organ.msh").string();
  writeStl(scan, spoiledSphere(0.05, 4), 0.001);
  expectOneLineError(run({"import", scan, "--unit", "mm", "-o", organ}), "--repair repairs it");
  const ProgramResult result = run({"import", scan, "--unit", "mm", "--repair", "--element-size", "0.01",
                                    "--fixed", "-z", "--fixed", "normal:0,-1,0,20", "-o", organ});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* part :
       {"repair           2 holes filled", "triangles turned over", "pairs of triangles crossed",
        "repair           volume 0.000", "estimate         about ", "volume           0.000"})
    EXPECT_NE(result.out.find(part), std::string::npos) << result.out;
  EXPECT_GT(mesh::readMesh(organ).groups.at("fixed").size(), 20U);
}

TEST(Program, TheEndingOfTheOutputSaysItsFormat) {
  const TemporaryFolder folder;
  const ProgramResult result = run({"beam", "-o", (folder / "beam.vtk").string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(mesh::readMesh(folder / "beam.vtk").nodes.size(), 1701U);
  EXPECT_NE(result.out.find("warning: a .vtk file keeps no groups"), std::string::npos) << result.out;
  for (const char* wrong : {"beam.stl", "beam", "beam.MSH"}) {
    const ProgramResult refused = run({"beam", "-o", (folder / wrong).string()});
    EXPECT_EQ(refused.exit_code, 2);
    expectOneLineError(refused, "the ending says the format, .msh (Gmsh) or .vtk");
    EXPECT_FALSE(std::filesystem::exists(folder / wrong));
  }
}

TEST(Program, UnitAndScaleExcludeEachOther) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.msh", mesh::test::kMsh1).string(),
                    to = (folder / "b.msh").string();
  expectOneLineError(run({"import", file, "--unit", "mm", "--scale", "1", "-o", to}), "--unit and --scale");
  expectOneLineError(run({"import", file, "--unit", "inch", "-o", to}), "--unit");
  const ProgramResult result = run({"import", file, "--unit", "cm", "--json", "-o", to});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out).at("bounding_box").at("max")[0], 0.01);
}

TEST(Program, WarnsOfAnImplausibleSize) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.msh", mesh::test::kMsh1).string();
  const auto complainsAt = [&](const std::string& scale) {
    const ProgramResult result = run({"import", file, "--scale", scale, "-o", (folder / "b.msh").string()});
    return result.out.find("implausible") != std::string::npos;
  };
  EXPECT_TRUE(complainsAt("3"));
  EXPECT_TRUE(complainsAt("0.001"));  // 1 mm
  EXPECT_FALSE(complainsAt("0.1"));
}

TEST(Program, RefusesInOneLineAndLeavesNoFile) {
  const TemporaryFolder folder;
  const auto target = folder / "b.msh";
  const auto import = [&](const std::string& file, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"import", file, "-o", target.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  expectOneLineError(import((folder / "none.msh").string()), "none.msh: no such file");
  const std::string file = folder.write("a.msh", mesh::test::kMsh2).string();
  expectOneLineError(import(file, {"--fixed", "group:no"}), "the file has curve:6, lower face");
  expectOneLineError(import(file, {"--fixed", ""}), "expected group:NAME");
  const auto cut = folder.write("cut.msh", mesh::test::kMsh2.substr(0, 200));
  expectOneLineError(import(cut.string()), "cut.msh: line");
  EXPECT_FALSE(std::filesystem::exists(target));
  expectOneLineError(run({"beam", "-o", (folder / "none/beam.msh").string()}), "cannot write");
}

TEST(Program, TellsABadFileFromACommandLineThatCannotBeUsed) {
  const TemporaryFolder folder;
  const auto code = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", (folder / "b.msh").string()});
    return run(arguments).exit_code;
  };
  const std::string file = folder.write("a.msh", mesh::test::kMsh2).string();
  EXPECT_EQ(code({"import", (folder / "none.msh").string()}), 1);
  EXPECT_EQ(code({"import", folder.write("cut.msh", mesh::test::kMsh2.substr(0, 200)).string()}), 1);
  EXPECT_EQ(code({"import", file, "--fixed", "group:no"}), 2);
  EXPECT_EQ(code({"import", file, "--repair"}), 2);
  EXPECT_EQ(code({"import", file, "--fixed", "lowest-z:2"}), 2);
  EXPECT_EQ(code({"import", file, "--element-size", "0.01"}), 2) << "a mesh has its elements";
  EXPECT_EQ(code({"import", "a.stl", "--element-size", "0.01", "--inner-size", "0.001"}), 2);
  EXPECT_EQ(code({"import", "a.stl", "--scale", "0"}), 2);
  EXPECT_EQ(code({"liver", "--element-size", "0.03"}), 2);
  EXPECT_EQ(code({"liver", "--inner-size", "0.001"}), 2);
}

TEST(Program, RefusesUnknownArgumentsInOneLineWithItsName) {
  const std::vector<std::vector<std::string>> wrong{{},
                                                    {"beam"},
                                                    {"spleen", "-o", "a.msh"},
                                                    {"beam", "-o", "a.msh", "--size", "3"},
                                                    {"beam", "-o", "a.msh", "--element-order", "2"},
                                                    {"paper-liver", "-o", "a.msh", "--element-order", "3"},
                                                    {"liver", "-o", "a.msh", "--element-size", "small"},
                                                    {"import", "-o", "a.msh"}};
  for (const auto& arguments : wrong) {
    SCOPED_TRACE(arguments.empty() ? "none" : arguments.back());
    expectOneLineError(run(arguments), "palpate-organ: ");
  }
  EXPECT_EQ(run({"--help"}).exit_code, 0);
  EXPECT_EQ(run({"import", "--help"}).exit_code, 0);
}

TEST(Program, ImportsTheLiverOfTheSofaFramework) {
  const TemporaryFolder folder;
  const std::string data = palpate::testing::dataDir() + "/sofa-liver/";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not there";
  const std::string to = (folder / "x.msh").string();
  const ProgramResult result = run(
      {"import", data + "liver2.msh", "--scale", "0.0933", "--fixed", "lowest-z:0.08", "--json", "-o", to});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("nodes"), 507);
  EXPECT_EQ(json.at("surface_nodes"), 432);
  EXPECT_EQ(json.at("fixed_nodes"), 35);
  const auto& box = json.at("bounding_box");
  EXPECT_NEAR(box.at("max")[0].get<double>() - box.at("min")[0].get<double>(), 0.2, 1e-3);
  expectOneLineError(run({"import", data + "liver_for_test_broken.vtk", "-o", to}), "POLYDATA");
  expectOneLineError(run({"import", data + "liver-smooth.obj", "-o", to}), "intersect");
  const ProgramResult repaired = run({"import", data + "liver-smooth.obj", "--scale", "0.03", "--repair",
                                      "--fixed", "lowest-z:0.08", "--json", "-o", to});
  ASSERT_EQ(repaired.exit_code, 0) << repaired.err;
  EXPECT_GT(nlohmann::json::parse(repaired.out).at("nodes"), 2000);
  EXPECT_NE(repaired.err.find("pairs of triangles crossed"), std::string::npos) << repaired.err;
}

}  // namespace
}  // namespace palpate::organ::test
