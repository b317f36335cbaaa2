// SPDX-License-Identifier: Apache-2.0
// What palpate-query refuses, in one line and with which exit code.
#include <fstream>

#include "query_program.h"

namespace palpate::query::test {
namespace {

/// The command line's fault.
void expectUnusable(const ProgramResult& result, const std::string& part) {
  EXPECT_EQ(result.exit_code, 2);
  expectOneLineError(result, part);
}

TEST(Program, RefusesALoadThatTheModelDoesNotTake) {
  const LoadModel box(Parameters::kLevel);
  const std::string node = std::to_string(BoxMesh::number(4, 2, 2));
  expectUnusable(query(box, {"--node", node, "--force", "0,0,-1"}), "use --load-level or --displacement");
  expectUnusable(query(box, {"--node", node, "--load-level", "1.5"}), "--load-level");
  expectUnusable(query(box, {"--node", node, "--load-level", "-0.5"}), "--load-level");
  expectUnusable(query(box, {"--node", node, "--load-level", "nan"}), "--load-level");
  expectUnusable(query(box, {"--node", node, "--load-level", "0.5", "--force", "0,0,0"}),
                 "--displacement,--force,--load-level");
  expectUnusable(query(box, {"--node", node, "--force", "0,0"}), "--force is '0,0'");
  expectUnusable(query(box, {"--node", node, "--force="}), "--force");
}

TEST(Program, RefusesAToolTooManyOrUnclear) {
  const BoxModel box;
  const std::string node = std::to_string(BoxMesh::number(3, 1, 2)),
                    other = std::to_string(BoxMesh::number(5, 1, 2));
  const auto refused = [&](std::vector<std::string> more, const std::string& part) {
    more.insert(more.begin(), {"--node", node, "--displacement", "0,0,-0.001"});
    expectUnusable(query(box, more), part);
  };
  refused({"--tool2", other + ":0,0"}, "--tool2 is '" + other + ":0,0', expected a node's number");
  refused({"--tool2", node + ":0,0,0"}, "both touch node " + node);
  refused({"--tool2", "4:0,0,0"}, "node 4 is not in the mesh");
  refused({"--tool2"}, "--tool2");
  refused({"--tool2", other + ":0,0,0", "--ccx", "deck.inp"}, "expected no --tool2");
  const LoadModel load(Parameters::kForce);
  expectUnusable(query(load, {"--node", node, "--force", "0,0,-0.01", "--tool2", other + ":0,0,0"}),
                 "expected --displacement");
}

TEST(Program, RefusesBadArgumentsInOneLine) {
  const BoxModel box;
  const std::string node = std::to_string(BoxMesh::number(4, 2, 2));
  expectUnusable(query(box, {"--node", "4", "--displacement", "0,0,0"}), "node 4 is not in the mesh");
  expectUnusable(query(box, {"--node", node, "--displacement", "0,0"}), "--displacement is '0,0'");
  expectUnusable(query(box, {"--at", "0,0,nan", "--displacement", "0,0,0"}), "--at is '0,0,nan'");
  expectUnusable(query(box, {"--displacement", "0,0,0"}), "--node,--at");
  expectUnusable(query(box, {"--node", node, "--at", "0,0,0", "--displacement", "0,0,0"}), "--node,--at");
  expectUnusable(query(box, {"--node", node}), "--displacement,--force,--load-level");
  expectUnusable(query(box, {"--node", "four", "--displacement", "0,0,0"}), "--node: four is not a number");
  expectUnusable(query(box, {"--node", node, "--displacement", "0,0,0", "--newton", "--steps", "0"}),
                 "--steps");
  expectUnusable(query(box, {"--node", node, "--displacement", "0,0,0", "--field", "/none/a.vtu"}),
                 "cannot write /none/a.vtu");
  EXPECT_EQ(query(box, {"--help"}).exit_code, 0);
}

TEST(Program, RefusesATruncatedModel) {
  const BoxModel box;
  std::filesystem::resize_file(box.path, std::filesystem::file_size(box.path) / 2);
  expectOneLineError(query(box, {"--node", "4", "--displacement", "0,0,0"}), "box.h5");
  std::filesystem::remove(box.path);
  const ProgramResult none = query(box, {"--node", "4", "--displacement", "0,0,0"});
  EXPECT_EQ(none.exit_code, 1);
  expectOneLineError(none, "cannot be opened");
}

TEST(Program, RefusesADisplacementLongerThanAnyTouch) {
  const BoxModel box;
  const std::string node = std::to_string(BoxMesh::number(5, 3, 2));
  expectUnusable(query(box, {"--node", node, "--displacement", "0,0,-2", "--newton"}),
                 "--displacement 0,0,-2 m is 2 m long, expected at most ");
  expectUnusable(query(box, {"--node", node, "--displacement", "0,0,-1e300"}), "m long, expected at most ");
  expectUnusable(query(box, {"--node", node, "--displacement", "0,0,-0.001", "--tool2",
                             std::to_string(BoxMesh::number(3, 1, 2)) + ":0,0,-1"}),
                 "--tool2 0,0,-1 m is 1 m long");
}

TEST(Program, RefusesAPlaceOffTheOrganAndSuspectsTheUnit) {
  const BoxModel box;
  expectUnusable(query(box, {"--at", "83,31,41", "--displacement", "0,0,-0.002"}),
                 "in millimetres it would lie 1 mm from the organ's surface: --unit mm");
  const std::vector<std::string> asked{"--at",   "83,31,41", "--displacement", "0,0,-2",
                                       "--unit", "mm",       "--json"};
  const ProgramResult result = query(box, asked);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_NEAR(json.at("anchor").at("distance_m").get<double>(), 0.001, 1e-15);
  EXPECT_LT((vectorOf(json.at("displacement")) - Vec3(0.0, 0.0, -0.002)).norm(), 1e-17);
  const std::string told = query(box, {asked.begin(), asked.end() - 1}).out;
  EXPECT_NE(told.find("1 mm from the asked place, which is outside the organ"), std::string::npos) << told;
  expectUnusable(query(box, {"--at", "8,3,4", "--displacement", "0,0,0", "--unit", "inch"}), "--unit");
}

TEST(Program, RefusesOptionsThatABatchHasNoPlaceFor) {
  const BoxModel box;
  const std::string touches = box.folder.write("t.csv", "");
  const auto refused = [&](std::vector<std::string> more, const std::string& part) {
    const ProgramResult result = query(box, std::move(more));
    expectUnusable(result, part);
  };
  refused({"--batch", touches, "--displacement", "0,0,0"}, "--batch goes with --unit and -o only");
  refused({"--batch", touches, "--newton"}, "--batch goes with --unit and -o only");
  refused({"--batch", touches, "-o", touches}, "would replace the touches");
  refused({"--at", "0.08,0.03,0.04", "--displacement", "0,0,0", "-o", "a.csv"}, "-o goes with --batch");
  expectUnusable(query(box, {"--batch", touches, "-o", "/none/a.csv"}), "cannot write /none/a.csv");
}

}  // namespace
}  // namespace palpate::query::test
