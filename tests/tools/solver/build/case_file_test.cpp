// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/case_file.h"

#include <gtest/gtest.h>

#include "palpate/testing/files.h"

namespace palpate::solver {
namespace {

class CaseFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const { return folder_.write("case.toml", text); }

  std::string refusal(const std::string& text) const {
    try {
      (void)readCase(write(text));
    } catch (const CaseError& error) {
      return error.what();
    }
    return "was taken";
  }

  void expectRefusal(const std::string& text, const std::string& where, const std::string& why) const {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(where), std::string::npos) << message;
    EXPECT_NE(message.find(why), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }

  const testing::TemporaryFolder folder_;
};

TEST_F(CaseFile, ReadsEveryKey) {
  const Case c = readCase(write(R"(mesh = "organ.msh"
[boundary]
fixed = "back"
accessible = "front"
[material]
law = "stable-neo-hookean"
E = 2000
nu = 0.3
[model]
patch_radius = 0.008
order = 4
modes = 60
near_radius = 0.02
sweeps = 3
)"));
  EXPECT_EQ(c.mesh.filename(), "organ.msh");
  EXPECT_EQ(c.mesh.parent_path(), folder_.path());
  EXPECT_EQ(c.fixed, "back");
  EXPECT_EQ(c.accessible.value(), "front");
  EXPECT_EQ(c.law, "stable-neo-hookean");
  EXPECT_EQ(c.E, 2000.0);
  EXPECT_EQ(c.nu, 0.3);
  EXPECT_EQ(c.patch_radius.value(), 0.008);
  EXPECT_EQ(c.order, 4);
  EXPECT_EQ(c.modes, 60);
  EXPECT_EQ(c.near_radius.value(), 0.02);
  EXPECT_EQ(c.sweeps, 3);
}

TEST_F(CaseFile, ReadsRegionsAndSprings) {
  const Case c = readCase(write(R"(mesh = "organ.msh"
[[region]]
group = "nodule"
E = 70e3
[[region]]
group = "vessel"
E = 5e5
nu = 0.3
law = "stvk"
[[spring]]
group = "bed"
stiffness = 1e6
)"));
  ASSERT_EQ(c.regions.size(), 2U);
  EXPECT_EQ(c.regions[0].group, "nodule");
  EXPECT_EQ(c.regions[0].E, 70e3);
  EXPECT_FALSE(c.regions[0].nu.has_value());
  EXPECT_FALSE(c.regions[0].law.has_value());
  EXPECT_EQ(c.regions[0].place, (folder_ / "case.toml").string() + ":3: region.group");
  EXPECT_EQ(c.regions[1].nu.value(), 0.3);
  EXPECT_EQ(c.regions[1].law.value(), "stvk");
  ASSERT_EQ(c.springs.size(), 1U);
  EXPECT_EQ(c.springs[0].group, "bed");
  EXPECT_EQ(c.springs[0].stiffness, 1e6);
}
TEST_F(CaseFile, RefusesARegionThatIsNotWhole) {
  expectRefusal("mesh = \"a\"\n[[region]]\nE = 1.0\n", ".toml:2: region.group", "is missing");
  expectRefusal("mesh = \"a\"\n[[region]]\ngroup = \"b\"\n", ".toml:2: region.E", "is missing");
  expectRefusal("mesh = \"a\"\n[[spring]]\ngroup = \"b\"\n", ".toml:2: spring.stiffness", "is missing");
}
TEST_F(CaseFile, RefusesKeysOfARegionByNameAndLine) {
  const std::string region = "mesh = \"a\"\n[[region]]\ngroup = \"b\"\nE = 1.0\n";
  expectRefusal(region + "young = 2\n", ".toml:5: region.young", "not known");
  expectRefusal(region + "nu = 0.5\n", ".toml:5: region.nu", "0.5 is out of range");
  expectRefusal(region + "law = \"jelly\"\n", ".toml:5: region.law", "jelly");
  expectRefusal("mesh = \"a\"\n[[region]]\ngroup = 3\n", ".toml:3: region.group", "not a string");
  expectRefusal("mesh = \"a\"\n[region]\n", ".toml:2: region", "is not an array of tables, [[region]]");
  expectRefusal("mesh = \"a\"\n[[spring]]\ngroup = \"b\"\nstiffness = 0\n", ".toml:4: spring.stiffness",
                "0 is out of range");
}

TEST_F(CaseFile, LeavesDefaultsWhereAKeyIsAbsent) {
  const Case c = readCase(write("mesh = \"organ.msh\"\n"));
  EXPECT_EQ(c.E, 160e3);
  EXPECT_EQ(c.nu, 0.48);
  EXPECT_EQ(c.orders().fields, 3);
  EXPECT_EQ(c.orders().answer, 6);
  EXPECT_FALSE(c.accessible.has_value());
  EXPECT_FALSE(c.patch_radius.has_value());
}

TEST_F(CaseFile, RefusesAnUnknownKeyByNameAndLine) {
  expectRefusal("mesh = \"a\"\n[material]\nyoung = 3\n", ".toml:3: material.young", "not known");
}
TEST_F(CaseFile, RefusesAnUnknownTable) {
  expectRefusal("mesh = \"a\"\n[solver]\n", ".toml:2: solver", "not known");
}
TEST_F(CaseFile, RefusesAWrongType) {
  expectRefusal("mesh = \"a\"\n[model]\norder = \"three\"\n", ".toml:3: model.order", "not an integer");
}
TEST_F(CaseFile, RefusesANumberForAString) {
  expectRefusal("mesh = 5\n", ".toml:1: mesh", "not a string");
}
TEST_F(CaseFile, RefusesAFractionForAnInteger) {
  expectRefusal("mesh = \"a\"\n[model]\nmodes = 10.5\n", ".toml:3: model.modes", "not an integer");
}
TEST_F(CaseFile, RefusesPoissonsRatioOfAFluid) {
  expectRefusal("mesh = \"a\"\n[material]\nnu = 0.5\n", ".toml:3: material.nu", "0.5 is out of range");
}
TEST_F(CaseFile, RefusesANegativeModulus) {
  expectRefusal("mesh = \"a\"\n[material]\nE = -1\n", ".toml:3: material.E", "-1 is out of range");
}
TEST_F(CaseFile, RefusesNotANumber) {
  expectRefusal("mesh = \"a\"\n[material]\nE = nan\n", ".toml:3: material.E", "out of range");
}
TEST_F(CaseFile, RefusesAnUnknownLaw) {
  expectRefusal("mesh = \"a\"\n[material]\nlaw = \"jelly\"\n", ".toml:3: material.law", "jelly");
}
TEST_F(CaseFile, RefusesAnOrderAboveSeven) {
  expectRefusal("mesh = \"a\"\n[model]\norder = 8\n", ".toml:3: model.order", "[1, 7]");
  expectRefusal("mesh = \"a\"\n[model]\nforce_order = 9\n", ".toml:3: model.force_order", "[1, 8]");
  expectRefusal("mesh = \"a\"\n[model]\ntravel = 0\n", ".toml:3: model.travel", "(0, 1]");
}
TEST_F(CaseFile, RefusesAMissingMesh) {
  expectRefusal("[model]\norder = 3\n", ".toml", "mesh is missing");
}
TEST_F(CaseFile, RefusesTextThatIsNotToml) {
  expectRefusal("mesh = \"a\"\n[[[\n", ".toml:2", "");
}
TEST_F(CaseFile, RefusesAFileThatIsNotThere) {
  EXPECT_THROW((void)readCase("/nowhere/case.toml"), CaseError);
}

TEST_F(CaseFile, ReadsEveryKeyOfALoadAndOfThePgd) {
  const Case c = readCase(write(R"(mesh = "organ.msh"
[model]
method = "pgd-linear"
modes = 50
[load]
direction = [0, 3, -4.0]
magnitude = 2
steps = 40
kind = "node"
truncation = 12
[pgd]
separation = "hadamard"
tolerance = 1e-4
greedy_pairs = 90
sweeps = 5
update = 4
block = 1
)"));
  EXPECT_EQ(c.method, Method::kPgdLinear);
  EXPECT_LT((c.load.unitDirection() - Vec3(0.0, 0.6, -0.8)).norm(), 1e-15);
  EXPECT_EQ(c.load.magnitude.value(), 2.0);
  EXPECT_EQ(c.load.steps.value(), 40);
  EXPECT_TRUE(c.nodalLoad());
  EXPECT_EQ(c.load.truncation.value(), 12);
  EXPECT_TRUE(c.pgd.hadamard.value());
  EXPECT_EQ(c.pgd.tolerance.value(), 1e-4);
  EXPECT_EQ(c.pgd.greedy_pairs.value(), 90);
  EXPECT_EQ(c.pgd.sweeps.value(), 5);
  EXPECT_EQ(c.pgd.update.value(), 4);
  EXPECT_EQ(c.pgd.block.value(), 1);
}

TEST_F(CaseFile, ALoadPointsDownWhereNothingElseIsSaid) {
  EXPECT_EQ(readCase(write("mesh = \"a\"\n")).load.unitDirection(), Vec3(0.0, 0.0, -1.0));
}
TEST_F(CaseFile, LoadDrivenModelsHaveThePapersNumberOfPairs) {
  const Case c = readCase(write("mesh = \"a\"\n"));
  EXPECT_FALSE(c.modes.has_value());
  EXPECT_DOUBLE_EQ(c.fieldErrorOrDefault(), 0.01);
  EXPECT_DOUBLE_EQ(c.nearRadiusOrDefault(0.002), 0.009);  // follows the patch, no length of its own
  for (const char* method : {"series-force", "pgd-linear", "pgd-explicit", "pgd-euler"})
    EXPECT_EQ(
        readCase(write("mesh = \"a\"\nmodel.method = \"" + std::string(method) + "\"\n")).modesOrDefault(),
        167);
}
TEST_F(CaseFile, RefusesAnUnknownMethodAndListsThoseThereAre) {
  expectRefusal("mesh = \"a\"\n[model]\nmethod = \"pod\"\n", ".toml:3: model.method",
                "\"pod\" is not known (known: series-displacement, series-force, pgd-linear");
}
TEST_F(CaseFile, RefusesAMalformedDirection) {
  for (const char* direction : {"[0, 0, 0]", "[1, 2]", "\"up\"", "[1, 2, \"x\"]", "[nan, 0, 1]", "4"})
    expectRefusal("mesh = \"a\"\n[load]\ndirection = " + std::string(direction) + "\n",
                  ".toml:3: load.direction", "neither three numbers, not all zero, nor \"any\"");
}
TEST_F(CaseFile, RefusesALoadOfNothing) {
  expectRefusal("mesh = \"a\"\n[load]\nmagnitude = 0\n", ".toml:3: load.magnitude", "0 is out of range");
}
TEST_F(CaseFile, RefusesAnUnknownKindOfLoad) {
  expectRefusal("mesh = \"a\"\n[load]\nkind = \"line\"\n", ".toml:3: load.kind", "known: patch, node");
}

/// What checkCase says to keys of a method.
class CaseCheck : public CaseFile {
 protected:
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
  expectRefused(method, "model.travel = 0.01\nmodel.order = 4", "model.travel", "it chooses both");
  expectRefused("series-force", "model.travel = 0.01", "model.travel", "it is for series-displacement");
  expectRefused("series-force", "model.force_order = 3", "model.force_order",
                "it is for series-displacement");
  const Case c = readCase(write("mesh = \"a\"\n[model]\norder = 4\nforce_order = 8\ntravel = 0.01\n"));
  EXPECT_EQ(c.orders().answer, 8);
  EXPECT_EQ(c.travel, 0.01);
}
TEST_F(CaseCheck, OnlyTheThreePartModelHasANearField) {
  for (const char* method : {"series-force", "pgd-linear", "pgd-explicit", "pgd-euler"}) {
    expectRefused(method, "model.near_radius = 0.02", "model.near_radius", "it is for series-displacement");
    expectRefused(method, "model.field_error = 0.02", "model.field_error", "it is for series-displacement");
  }
  expectRefused("series-displacement", "model.field_error = 0.02\nmodel.modes = 9", "model.field_error",
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
