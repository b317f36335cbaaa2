// SPDX-License-Identifier: Apache-2.0
// From an organ to errors against Newton, through the programs, as the default organ shows them. On a coarser liver,
// since every comparison is a full solution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <sstream>

#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"
#include "tools/mesh/read_mesh.h"
#include "tools/mesh/topology.h"

namespace palpate {
namespace {

using nlohmann::json;
using testing::runProgram;

std::string text(const Eigen::Vector3d& x) {
  std::ostringstream out;
  out.precision(17);
  out << x[0] << ',' << x[1] << ',' << x[2];
  return out.str();
}

constexpr std::size_t kTouches = 12;

double worst(const std::vector<double>& errors) {
  EXPECT_EQ(errors.size(), kTouches);
  return *std::max_element(errors.begin(), errors.end());
}

class CoarseLiver : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_.emplace();
    const auto made = runProgram(
        "palpate-organ", {"paper-liver", "--element-size", "0.017", "-o", (*folder_ / "liver.msh").string()});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto solved = runProgram("palpate-solve", {(*folder_ / "liver.msh").string(), "--element-order",
                                                     "1", "-o", (*folder_ / "liver.h5").string(), "-q"});
    ASSERT_EQ(solved.exit_code, 0) << solved.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  void SetUp() override {
    organ_ = mesh::readMesh(*folder_ / "liver.msh");
    accessible_ = organ_.groups.at("accessible");
  }

  Eigen::Vector3d touch() {
    return 2e-3 * Eigen::Vector3d(normal_(random_), normal_(random_), normal_(random_)).normalized();
  }

  void compare(const std::vector<std::string>& where, std::vector<double>& force,
               std::vector<double>& field) {
    std::vector<std::string> arguments{(*folder_ / "liver.h5").string(), "--displacement", text(touch()),
                                       "--newton", "--json"};
    arguments.insert(arguments.end(), where.begin(), where.end());
    const auto result = runProgram("palpate-query", arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json answer = json::parse(result.out);
    force.push_back(answer.at("newton").at("force_error"));
    field.push_back(answer.at("newton").at("field_error_max"));
  }

  static std::optional<testing::TemporaryFolder> folder_;
  mesh::TetMesh organ_;
  std::vector<std::int32_t> accessible_;
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

std::optional<testing::TemporaryFolder> CoarseLiver::folder_;

TEST_F(CoarseLiver, AtNodesForceIsExactAndFieldWithin1Percent) {
  std::vector<double> force, field;
  for (std::size_t i = 0; i < kTouches; ++i) {
    const std::int32_t node = accessible_[random_() % accessible_.size()];
    compare({"--node", std::to_string(organ_.node_tags[static_cast<std::size_t>(node)])}, force, field);
  }
  EXPECT_LT(worst(force), 1e-5);
  EXPECT_LT(worst(field), 0.01);
}

TEST_F(CoarseLiver, BetweenNodesForceAndFieldAreWithin1Percent) {
  const mesh::BoundarySurface boundary = mesh::boundaryOf(organ_);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> force, field;
  while (force.size() < kTouches) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    double a = uniform(random_), b = uniform(random_);
    if (a + b > 1.0) {
      a = 1.0 - a;
      b = 1.0 - b;
    }
    const auto& triangle = boundary.triangles[random_() % boundary.triangles.size()];
    const double weight[3] = {a, b, 1.0 - a - b};
    bool all = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t node = boundary.nodes[static_cast<std::size_t>(triangle[k])];
      all = all && std::binary_search(accessible_.begin(), accessible_.end(), node);
      x += weight[k] * organ_.nodes[static_cast<std::size_t>(node)];
    }
    if (all) compare({"--at", text(x)}, force, field);
    if (HasFatalFailure()) return;
  }
  EXPECT_LT(worst(force), 0.01);
  EXPECT_LT(worst(field), 0.01);
}

TEST_F(CoarseLiver, PolynomialsOfAllButFivePercentReach4MillimetresAndTheirDomain2) {
  const auto result = runProgram("palpate-inspect", {(*folder_ / "liver.h5").string(), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(json::parse(result.out).at("series_radius").at("p05"), 4e-3);
  EXPECT_GE(json::parse(result.out).at("domain_radius").at("p05"), 2e-3);
}

}  // namespace
}  // namespace palpate
