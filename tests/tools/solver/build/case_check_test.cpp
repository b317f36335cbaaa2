// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "palpate/testing/files.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solver {
namespace {

/// What checkCase says to keys of a method.
class CaseCheck : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const { return folder_.write("case.toml", text); }

  void expectRefused(const std::string& method, const std::string& keys, const std::string& key,
                     const std::string& why) const {
    const Case c = readCase(write("mesh = \"a\"\nmodel.method = \"" + method + "\"\n" + keys + "\n"));
    try {
      checkCase(c);
      FAIL() << method << " took " << keys;
    } catch (const CaseError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(key, 0), 0U) << error.what();
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  }

  const testing::TemporaryFolder folder_;
};

TEST_F(CaseCheck, TakesEveryMethodWithNothingButAMesh) {
  for (const char* method :
       {"series-displacement", "series-force", "pgd-linear", "pgd-explicit", "pgd-euler"})
    EXPECT_NO_THROW(
        checkCase(readCase(write("mesh = \"a\"\nmodel.method = \"" + std::string(method) + "\"\n"))));
}
TEST_F(CaseCheck, TheOrderIsThatOfASeries) {
  for (const char* method : {"pgd-linear", "pgd-explicit", "pgd-euler"})
    expectRefused(method, "model.order = 3", "model.order", "it is for series-displacement, series-force");
}
TEST_F(CaseCheck, TheOrdersFitEachOtherAndATravelChoosesBoth) {
  const char* const method = "series-displacement";
  expectRefused(method, "model.force_order = 7", "model.force_order", "expected 3 to 6");
  expectRefused(method, "target.travel = 0.01\nmodel.order = 4", "target.travel", "it chooses both");
  expectRefused("series-force", "target.travel = 0.01", "target.travel", "it is for series-displacement");
  expectRefused("series-force", "model.force_order = 3", "model.force_order",
                "it is for series-displacement");
  expectRefused(method, "target.travel = 0.01\nmodel.force_order = 6", "target.travel", "it chooses both");
  const Case orders = readCase(write("mesh = \"a\"\n[model]\norder = 4\nforce_order = 8\n"));
  const Case travel = readCase(write("mesh = \"a\"\ntarget.travel = 0.05\n"));
  EXPECT_EQ(orders.orders().answer, 8);
  EXPECT_EQ(travel.travel, 0.05);
  for (const Case& c : {orders, travel}) EXPECT_NO_THROW(checkCase(c));
}
TEST_F(CaseCheck, ASizeIsThatOfAHandheldModel) {
  const char* const method = "series-displacement";
  expectRefused(method, "target.size_limit = 8e6", "target.size_limit", "it is for handheld");
  expectRefused(method, "target.machine = \"handheld\"\ntarget.field_error = 0.02", "target.field_error",
                "target.size_limit chooses the modes");
  for (const char* other : {"series-force", "pgd-linear"}) {
    expectRefused(other, "target.machine = \"handheld\"", "target.machine", "it is for series-displacement");
    expectRefused(other, "target.size_limit = 8e6", "target.size_limit", "it is for series-displacement");
  }
  EXPECT_THROW((void)readCase(write("mesh = \"a\"\ntarget.machine = \"phone\"\n")), CaseError);
  EXPECT_THROW((void)readCase(write("mesh = \"a\"\ntarget.size_limit = 1000\n")), CaseError);
  const Case alone = readCase(write("mesh = \"a\"\ntarget.machine = \"handheld\"\n"));
  EXPECT_NO_THROW(checkCase(alone));
  EXPECT_EQ(alone.orders().fields, 3);
  EXPECT_EQ(alone.travelOrDefault(), 0.004);
  EXPECT_EQ(alone.sizeLimitOrDefault(), 8e6);
  const Case longer = readCase(write("mesh = \"a\"\n[target]\nmachine = \"handheld\"\ntravel = 0.007\n"));
  EXPECT_EQ(longer.sizeLimitOrDefault(), 20e6);
  const Case limited = readCase(write("mesh = \"a\"\n[target]\nmachine = \"handheld\"\nsize_limit = 5e6\n"));
  EXPECT_EQ(limited.sizeLimitOrDefault(), 5e6);
}
TEST_F(CaseCheck, ALinearForceWouldLeaveNothingToJudgeItsDomainBy) {
  expectRefused("series-displacement", "model.order = 1\nmodel.force_order = 3", "model.force_order = 3",
                "expected 2 to 2");
  Case c = defaultCase("a");
  c.order = 1;
  EXPECT_NO_THROW(checkCase(c));
  c.force_order = 1;
  EXPECT_THROW(checkCase(c), CaseError);
}
TEST_F(CaseCheck, OnlyTheThreePartModelHasANearField) {
  for (const char* method : {"series-force", "pgd-linear", "pgd-explicit", "pgd-euler"}) {
    expectRefused(method, "model.near_radius = 0.02", "model.near_radius", "it is for series-displacement");
    expectRefused(method, "target.field_error = 0.02", "target.field_error", "it is for series-displacement");
  }
  expectRefused("series-displacement", "target.field_error = 0.02\nmodel.modes = 9", "target.field_error",
                "model.modes");
}
TEST_F(CaseCheck, ASeriesHoldsEveryLoad) {
  for (const char* method : {"series-displacement", "series-force"})
    for (const char* key : {"load.direction = [1, 0, 0]", "load.direction = \"any\"", "load.magnitude = 1",
                            "load.kind = \"node\"", "load.steps = 3", "load.truncation = 3"}) {
      const std::string name = std::string(key).substr(0, std::string(key).find(' '));
      expectRefused(method, key, name, "has no effect with method " + std::string(method));
    }
}
TEST_F(CaseCheck, ASeriesEnrichesNoPairs) {
  for (const char* key : {"separation = \"scalar\"", "tolerance = 0.1", "greedy_pairs = 300", "sweeps = 3",
                          "update = 3", "block = 1"})
    expectRefused("series-force", "pgd." + std::string(key), "pgd.",
                  "has no effect with method series-force");
}
TEST_F(CaseCheck, TheLinearPgdTakesNoSteps) {
  expectRefused("pgd-linear", "load.steps = 10", "load.steps", "no load steps");
}
TEST_F(CaseCheck, LoadSteppingTakesTheLoadAndItsPairsAsTheyAre) {
  for (const char* key :
       {"load.truncation = 5", "pgd.separation = \"hadamard\"", "pgd.update = 3", "pgd.block = 2"})
    expectRefused("pgd-explicit", key, "", "it is for pgd-linear");
}
TEST_F(CaseCheck, ANonlinearAnswerToAnyDirectionIsForTheForceSeries) {
  for (const char* method : {"pgd-explicit", "pgd-euler"})
    expectRefused(method, "load.direction = \"any\"", "load.direction",
                  "method series-force holds every direction");
}
TEST_F(CaseCheck, LoadSteppingEnrichesUpToATolerance) {
  for (const char* method : {"pgd-explicit", "pgd-euler"})
    expectRefused(method, "pgd.tolerance = 0", "pgd.tolerance = 0", "without end");
  EXPECT_NO_THROW(
      checkCase(readCase(write("mesh = \"a\"\nmodel.method = \"pgd-linear\"\npgd.tolerance = 0\n"))));
}
TEST_F(CaseCheck, HadamardPairsComeOneAtATime) {
  expectRefused("pgd-linear", "pgd.separation = \"hadamard\"\npgd.block = 4", "pgd.block = 4",
                "one at a time");
}
TEST_F(CaseCheck, ANodalLoadHasNoPatch) {
  expectRefused("pgd-linear", "load.kind = \"node\"\nmodel.patch_radius = 0.01", "model.patch_radius",
                "no patch");
}
TEST_F(CaseCheck, PairsAreNotRecompressedToMore) {
  expectRefused("pgd-linear", "model.modes = 20\npgd.greedy_pairs = 10", "pgd.greedy_pairs = 10", "20 modes");
}

}  // namespace
}  // namespace palpate::solver
