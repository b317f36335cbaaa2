// SPDX-License-Identifier: Apache-2.0
// palpate-feel contrast as its own process.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "palpate/testing/run_program.h"
#include "stiffer_top.h"

namespace palpate::testing {

namespace {

ProgramResult contrast(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "contrast");
  return runProgram("palpate-feel", arguments);
}

class ContrastProgram : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    modelfile::writeModel(*folder_ / "with.h5", stifferTop(kMost));
    modelfile::writeModel(*folder_ / "without.h5", stifferTop(0.0));
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string file(const std::string& name) { return (*folder_ / name).string(); }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
};

}  // namespace

TEST_F(ContrastProgram, PrintsOneObjectAndWritesTheMap) {
  const ProgramResult run =
      contrast({file("with.h5"), file("without.h5"), "--json", "--map", file("map.svg")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["depth"], 0.005);
  EXPECT_NEAR(json["largest"]["contrast"], kMost, 1e-6);
  EXPECT_NEAR(json["largest"]["position"][2], kTop.z(), 1e-9);
  EXPECT_NEAR(json["largest"]["force"].get<double>() / json["largest"]["force_without"].get<double>(),
              1.0 + kMost, 1e-6);
  EXPECT_NEAR(json["regions"]["nodule"]["contrast"], kMost, 0.01 * kMost);
  EXPECT_EQ(json["rings"].size(), 6U);
  EXPECT_TRUE(json["rings"][5]["to"].is_null());
  EXPECT_EQ(json["beyond_domain"], 0);
  EXPECT_GT(json["share_above_half"], 0.01);
  EXPECT_EQ(contentOf(file("map.svg")).find("<svg "), 0U);
}

TEST_F(ContrastProgram, DepthIsWhatIsAskedFor) {
  const ProgramResult run = contrast({file("with.h5"), file("without.h5"), "--depth", "0.009"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out.find("presses            9 mm deep at "), 0U) << run.out;
  EXPECT_NE(run.out.find("contrast 60.0 %, beyond d_max"), std::string::npos) << run.out;
}

TEST_F(ContrastProgram, RefusesOtherMapsThanItWrites) {
  for (const char* name : {"map.png", "map", "map.svg.gz", ".svg"}) {
    expectOneLineError(contrast({file("with.h5"), file("without.h5"), "--map", file(name)}),
                       "expected a name that ends in .svg or .vtu");
    EXPECT_FALSE(std::filesystem::exists(file(name)));
  }
}

TEST_F(ContrastProgram, RefusesAnotherOrgan) {
  writeSyntheticModel(file("other.h5"), {.subdivisions = 2});
  expectOneLineError(contrast({file("with.h5"), file("other.h5"), "--map", file("none.svg")}),
                     "the surfaces differ: 2562 nodes, without 162");
  EXPECT_FALSE(std::filesystem::exists(file("none.svg")));
}

}  // namespace palpate::testing
