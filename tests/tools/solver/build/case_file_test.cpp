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
  expectRefusal("mesh = \"a\"\n[model]\nforce_order = 9\n", ".toml:3: model.force_order", "[2, 8]");
  expectRefusal("mesh = \"a\"\n[target]\ntravel = 0\n", ".toml:3: target.travel", "(0, 0.05]");
  expectRefusal("mesh = \"a\"\n[target]\ntravel = 0.051\n", ".toml:3: target.travel", "(0, 0.05]");
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

}  // namespace
}  // namespace palpate::solver
