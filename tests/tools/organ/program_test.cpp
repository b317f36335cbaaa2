// SPDX-License-Identifier: Apache-2.0
// palpate-organ as its user sees it: exit code, standard output, standard error.
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "helpers.h"
#include "palpate/mesh/read_mesh.h"
#include "palpate/test/paths.h"
#include "samples.h"

namespace palpate::organ::test {
namespace {

using mesh::test::Folder;

struct Result {
  int code;
  std::string out, err;
};

std::string contentOf(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

Result run(const Folder& folder, const std::string& arguments) {
  const std::string out = (folder / "out").string();
  const std::string err = (folder / "err").string();
  const std::string command =
      palpate::testing::binDir() + "/palpate-organ " + arguments + " >" + out + " 2>" + err;
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentOf(out), contentOf(err)};
}

void expectOneLineError(const Result& result, const std::string& part) {
  EXPECT_EQ(result.code, 1) << result.err;
  EXPECT_TRUE(result.out.empty()) << result.out;
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
}

TEST(Program, WritesTheBeamAndTellsInJson) {
  const Folder folder;
  const auto file = folder / "beam.msh";
  const Result result = run(folder, "beam --json -o " + file.string());
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("nodes"), 1701);
  EXPECT_EQ(json.at("tetrahedra"), 7680);
  EXPECT_EQ(json.at("fixed_nodes"), 81);
  EXPECT_EQ(json.at("accessible_nodes"), 689);
  EXPECT_NEAR(json.at("volume"), 0.00064, 1e-15);
  EXPECT_TRUE(json.at("warnings").empty());
  EXPECT_EQ(mesh::readMesh(file).groups.at("fixed").size(), 81U);
}

TEST(Program, JsonIsUtf8WhateverTheNamesAre) {
  const Folder folder;
  std::string text = mesh::test::kMsh2;
  text.replace(text.find("lower face"), 5, "l\xff\xfew");
  const auto file = folder.write("a.msh", text);
  const Result result = run(folder, "import --json " + file.string() + " -o " + (folder / "b.msh").string());
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(nlohmann::json::accept(result.out)) << result.out;
}

TEST(Program, WritesALiverWithoutNoise) {
  const Folder folder;
  const Result result = run(folder, "liver --element-size 0.015 -o " + (folder / "liver.msh").string());
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.err.empty()) << result.err;
  EXPECT_EQ(result.out.find("Info"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("worst quality"), std::string::npos) << result.out;
}

TEST(Program, WarnsOfAnImplausibleSize) {
  const Folder folder;
  const auto file = folder.write("a.msh", mesh::test::kMsh1);
  const std::string to = " -o " + (folder / "b.msh").string();
  EXPECT_NE(run(folder, "import " + file.string() + " --scale 3" + to).out.find("implausible"),
            std::string::npos);
  EXPECT_NE(run(folder, "import " + file.string() + " --scale 0.001" + to).out.find("implausible"),
            std::string::npos);
  EXPECT_EQ(run(folder, "import " + file.string() + " --scale 0.1" + to).out.find("implausible"),
            std::string::npos);
}

TEST(Program, RefusesInOneLineAndLeavesNoFile) {
  const Folder folder;
  const auto target = folder / "b.msh";
  const std::string to = " -o " + target.string();
  expectOneLineError(run(folder, "import " + (folder / "none.msh").string() + to), "none.msh: no such file");
  const auto file = folder.write("a.msh", mesh::test::kMsh2);
  expectOneLineError(run(folder, "import " + file.string() + " --fixed group:no" + to),
                     "the file has curve:6, lower face");
  expectOneLineError(run(folder, "import " + file.string() + " --fixed ''" + to), "expected group:NAME");
  const auto cut = folder.write("cut.msh", mesh::test::kMsh2.substr(0, 200));
  expectOneLineError(run(folder, "import " + cut.string() + to), "cut.msh: line");
  EXPECT_FALSE(std::filesystem::exists(target));
  expectOneLineError(run(folder, "beam -o " + (folder / "none/beam.msh").string()), "cannot be written");
}

TEST(Program, RefusesUnknownArgumentsInOneLineWithItsName) {
  const Folder folder;
  for (const char* wrong : {"", "beam", "spleen -o a.msh", "beam -o a.msh --size 3",
                            "liver -o a.msh --element-size small", "import -o a.msh"}) {
    const Result result = run(folder, wrong);
    EXPECT_GT(result.code, 0) << wrong;
    EXPECT_TRUE(result.out.empty()) << result.out;
    EXPECT_TRUE(result.err.starts_with("palpate-organ: ")) << result.err;
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  }
  EXPECT_EQ(run(folder, "--help").code, 0);
  EXPECT_EQ(run(folder, "import --help").code, 0);
}

TEST(Program, ImportsTheLiverOfTheSofaFramework) {
  const Folder folder;
  const std::string data = palpate::testing::dataDir() + "/sofa-liver/";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not there";
  const std::string to = " -o " + (folder / "x.msh").string();
  const Result result =
      run(folder, "import " + data + "liver2.msh --scale 0.0933 --fixed lowest-z:0.08 --json" + to);
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("nodes"), 507);
  EXPECT_EQ(json.at("surface_nodes"), 432);
  EXPECT_EQ(json.at("fixed_nodes"), 35);
  EXPECT_NEAR(
      json.at("bounding_box").at("max")[0].get<double>() - json.at("bounding_box").at("min")[0].get<double>(),
      0.2, 1e-3);
  expectOneLineError(run(folder, "import " + data + "liver_for_test_broken.vtk" + to), "POLYDATA");
  expectOneLineError(run(folder, "import " + data + "liver-smooth.obj" + to), "intersect");
}

}  // namespace
}  // namespace palpate::organ::test
