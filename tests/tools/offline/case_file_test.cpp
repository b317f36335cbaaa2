// SPDX-License-Identifier: Apache-2.0
#include "palpate/offline/case_file.h"

#include <gtest/gtest.h>

#include <fstream>

namespace palpate::offline {
namespace {

class CaseFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() /
        (std::string("palpate_case_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
         ".toml");
    std::ofstream(path) << text;
    return path;
  }

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
};

TEST_F(CaseFile, ReadsEveryKey) {
  const Case c = readCase(write(R"(mesh = "organ.msh"
[boundary]
fixed = "back"
accessible = "front"
[material]
law = "stvk"
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
  EXPECT_EQ(c.mesh.parent_path(), std::filesystem::temp_directory_path());
  EXPECT_EQ(c.fixed, "back");
  EXPECT_EQ(c.accessible.value(), "front");
  EXPECT_EQ(c.E, 2000.0);
  EXPECT_EQ(c.nu, 0.3);
  EXPECT_EQ(c.patch_radius.value(), 0.008);
  EXPECT_EQ(c.order, 4);
  EXPECT_EQ(c.modes, 60);
  EXPECT_EQ(c.near_radius, 0.02);
  EXPECT_EQ(c.sweeps, 3);
}

TEST_F(CaseFile, LeavesDefaultsWhereAKeyIsAbsent) {
  const Case c = readCase(write("mesh = \"organ.msh\"\n"));
  EXPECT_EQ(c.E, 160e3);
  EXPECT_EQ(c.nu, 0.48);
  EXPECT_EQ(c.order, 3);
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

}  // namespace
}  // namespace palpate::offline
