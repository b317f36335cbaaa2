// SPDX-License-Identifier: Apache-2.0
// The paper's benchmarks on small meshes: what must hold on any mesh, and the rod, which is small by itself.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "palpate/testing/files.h"
#include "palpate/testing/paths.h"
#include "palpate/testing/run_program.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::ProgramResult;
using testing::runProgram;

class Reproduce : public ::testing::Test {
 protected:
  Json run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"-o", folder_.path().string(), "-q"});
    const ProgramResult result = runProgram("palpate-reproduce", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return Json::parse(text("results.json"));
  }
  [[nodiscard]] std::string text(const std::string& name) const { return testing::contentOf(folder_ / name); }
  /// Every picture that the report shows is there.
  void expectPictures() const {
    const std::string report = text("report.md");
    ASSERT_FALSE(report.empty());
    if (!testing::isInstalled("gnuplot")) return;
    int pictures = 0;
    for (std::size_t at = report.find("]("); at != std::string::npos; at = report.find("](", at + 1)) {
      const std::string name = report.substr(at + 2, report.find(')', at) - at - 2);
      EXPECT_TRUE(fs::exists(folder_ / name)) << name;
      ++pictures;
    }
    EXPECT_GT(pictures, 0);
  }

  const testing::TemporaryFolder folder_;
};

TEST_F(Reproduce, RodConvergesWithTheOrdersOfItsSchemes) {
  const Json rod = run({"rod", "--rod-elements", "10"});
  EXPECT_NEAR(rod.at("exact_tip_mm").get<double>(), 63.88194110594539, 1e-10);
  EXPECT_NEAR(rod.at("order").at("ten_term").get<double>(), 2.0, 0.1);
  EXPECT_NEAR(rod.at("order").at("forward_euler").get<double>(), 1.0, 0.1);
  EXPECT_NEAR(rod.at("order").at("constant_tangent").get<double>(), 1.0, 0.1);
  const Json& finest = rod.at("ten_term").back();
  EXPECT_NEAR(finest.at("dt").get<double>(), 1e-3, 1e-12);
  EXPECT_LE(finest.at("tip_error").get<double>(), 5e-7);
  EXPECT_EQ(finest.at("pairs"), 10);
  const double euler = rod.at("forward_euler").back().at("tip_error").get<double>();
  EXPECT_GE(euler, 1e-4);
  EXPECT_LE(euler, 3e-4);
  const Json& third = rod.at("series_displacement").at(2);
  EXPECT_EQ(third.at("order"), 3);
  EXPECT_LE(third.at("tip_error").get<double>(), 1e-12);
  expectPictures();
}

TEST_F(Reproduce, BeamAgreesWithNewtonAtEveryPosition) {
  const Json beam = run({"beam", "--beam-nodes", "9,3,3", "--beam-steps", "20"});
  ASSERT_EQ(beam.at("positions").size(), 24U);
  for (const Json& position : beam.at("positions"))
    EXPECT_LE(position.at("l2_error").get<double>(), 0.01) << position;
  const Json& volume = beam.at("volume_change");
  const double linear = volume.at("linear"), newton = volume.at("newton"), ten = volume.at("ten_term");
  EXPECT_GT(linear, 5.0 * std::abs(newton));
  EXPECT_LT(std::abs(ten - newton), 0.1 * linear);
  const Json& tip = beam.at("tip");
  EXPECT_LT(tip.at("forward_euler_error").get<double>(), 0.0);
  EXPECT_LT(std::abs(tip.at("ten_term_alone_error").get<double>()), 0.01);
  expectPictures();
}

TEST_F(Reproduce, LiverErrorsFallAsPairsAreAdded) {
  const Json liver = run({"liver", "--element-size", "0.02", "--coarse-element-size", "0.02", "--pairs",
                          "10,20,40", "--samples", "10"});
  double last = 1e9;
  ASSERT_EQ(liver.at("modes_table").size(), 3U);
  for (const Json& row : liver.at("modes_table")) {
    EXPECT_LT(row.at("field_error_p95").get<double>(), last);
    last = row.at("field_error_p95");
  }
  ASSERT_EQ(liver.at("linear").at("pairs_table").size(), 3U);
  for (const Json& row : liver.at("linear").at("pairs_table")) {
    EXPECT_LE(row.at("ratio").get<double>(), 1.1);
    EXPECT_GE(row.at("ratio").get<double>(), 1.0 - 1e-6);
    EXPECT_LE(row.at("greedy_pairs").get<double>(), 1.5 * row.at("pairs").get<double>());
  }
  EXPECT_LT(liver.at("three_part").at("contact_error_p95"),
            liver.at("modes_table").back().at("contact_error_p95"));
  EXPECT_GT(liver.at("evaluations_per_second").get<double>(), 0.0);
  const Json& ten = liver.at("ten_term");
  EXPECT_LT(ten.at("contact_error_p95").get<double>(),
            0.5 * ten.at("linear_contact_error_p95").get<double>());
  expectPictures();
}

TEST_F(Reproduce, QuickRunsTheSmallerCasesAndSaysSo) {
  const Json rod = run({"rod", "--quick"});
  EXPECT_EQ(rod.at("elements"), 20);
  EXPECT_EQ(rod.at("run").at("quick"), true);
  EXPECT_NE(text("report.md").find("**A quick run**"), std::string::npos);
  const Json full = run({"rod", "--rod-elements", "5"});
  EXPECT_EQ(full.at("run").at("quick"), false);
  EXPECT_EQ(text("report.md").find("**A quick run**"), std::string::npos);
}

TEST_F(Reproduce, QuickHasEveryFigureAndLeavesGivenOptionsAlone) {
  const Json all =
      run({"all", "--quick", "--rod-elements", "5", "--beam-nodes", "5,3,3", "--beam-steps", "5",
           "--element-size", "0.02", "--coarse-element-size", "0", "--pairs", "10,20", "--samples", "5"});
  EXPECT_EQ(all.at("run").at("quick"), true);
  EXPECT_EQ(all.at("rod").at("elements"), 5);
  EXPECT_EQ(all.at("beam").at("nodes_along"), "5 x 3 x 3");
  EXPECT_EQ(all.at("beam").at("steps"), 5);
  EXPECT_EQ(all.at("liver").at("modes_table").size(), 2U);
  EXPECT_EQ(all.at("liver").at("samples"), 5);
  EXPECT_FALSE(all.at("liver").contains("ten_term"));
  const std::string report = text("report.md");
  for (const char* figure :
       {"rod/figure-1-rod-convergence.svg", "beam/figure-2-beam-model.png", "beam/figure-3-beam-deformed.png",
        "beam/figure-4-beam-forward-euler.png", "beam/figure-beam-positions.svg", "beam/figure-beam-load.svg",
        "liver/figure-5-liver-model.png", "liver/figure-6-liver-x.png", "liver/figure-7-liver-y.png",
        "liver/figure-liver-errors.svg"})
    EXPECT_NE(report.find(figure), std::string::npos) << figure;
  expectPictures();
}

/// Part 5 of the paper's track on a real mesh: n pairs are as good as the best n.
TEST_F(Reproduce, PairsOfARealLiverAreAsGoodAsCanBe) {
  const fs::path mesh = fs::path(palpate::testing::dataDir()) / "sofa-liver" / "liver2.msh";
  if (!fs::exists(mesh)) GTEST_SKIP() << mesh << " is not there";
  const std::string organ = (folder_ / "organ.msh").string();
  ASSERT_EQ(runProgram("palpate-organ", {"import", mesh.string(), "--scale", "0.0933", "--fixed",
                                         "lowest-z:0.08", "-o", organ})
                .exit_code,
            0);
  const Json liver = run({"liver", "--mesh", organ, "--coarse-element-size", "0", "--pairs", "20,50,100,167",
                          "--samples", "10"});
  ASSERT_EQ(liver.at("linear").at("pairs_table").size(), 4U);
  for (const Json& row : liver.at("linear").at("pairs_table")) {
    EXPECT_LE(row.at("ratio").get<double>(), 1.1) << row;
    EXPECT_LE(row.at("greedy_pairs").get<double>(), 1.5 * row.at("pairs").get<double>());
  }
  const ProgramResult answer =
      runProgram("palpate-query", {(folder_ / "liver-167-pairs.h5").string(), "--at=0.0084,0.0054,0.0404",
                                   "--force=0,0,-1", "--newton", "--json"});
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_LT(Json::parse(answer.out).at("newton").at("displacement_error").get<double>(), 0.2);
}

TEST(ReproduceProgram, NamesWhatItDoesNotKnow) {
  const ProgramResult result = runProgram("palpate-reproduce", {"kidney"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(result.err.find("kidney"), std::string::npos) << result.err;
}

TEST(ReproduceProgram, RefusesAMeshThatIsNotThere) {
  const testing::TemporaryFolder folder;
  const ProgramResult result = runProgram(
      "palpate-reproduce", {"liver", "--mesh", "/nonexistent.msh", "-o", folder.path().string(), "-q"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("/nonexistent.msh"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace palpate
