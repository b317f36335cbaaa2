// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/case_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <stdexcept>

#include "palpate/testing/files.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solver {
namespace {

class CaseKeys : public ::testing::Test {
 protected:
  Case read(const std::string& text) const { return readCase(folder_.write("case.toml", text)); }
  std::string refusal(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const CaseError& error) {
      return error.what();
    }
    return "was taken";
  }
  /// A case with what its tables cannot do without, and one line more in one of them.
  static std::string caseWith(std::string_view table, const std::string& line) {
    const std::string in = table == "mesh" ? "" : "mesh = \"a\"\n";
    if (table == "mesh") return "[mesh]\nfile = \"a\"\n" + line;
    if (table == "region") return in + "[[region]]\ngroup = \"a\"\nE = 1\n" + line;
    if (table == "spring") return in + "[[spring]]\ngroup = \"a\"\nstiffness = 1\n" + line;
    return in + "[" + std::string(table) + "]\n" + line;
  }

  const palpate::testing::TemporaryFolder folder_;
};

TEST_F(CaseKeys, TheTemplateReadsAsTheDefaults) {
  const Case c = read(caseTemplate("my \"organ\".msh", false)), usual = defaultCase("organ.msh");
  checkCase(c);
  EXPECT_EQ(c.mesh.filename(), "my \"organ\".msh");
  EXPECT_EQ(c.fixed, usual.fixed);
  EXPECT_EQ(c.accessible, usual.accessible);
  EXPECT_EQ(c.law, usual.law);
  EXPECT_EQ(c.E, usual.E);
  EXPECT_EQ(c.nu, usual.nu);
  EXPECT_EQ(c.method, usual.method);
  EXPECT_EQ(c.mesh_error, usual.mesh_error);
  EXPECT_EQ(c.target, usual.target);
  EXPECT_EQ(c.forceErrorOrDefault(), usual.forceErrorOrDefault());
  EXPECT_EQ(c.fieldErrorOrDefault(), usual.fieldErrorOrDefault());
  EXPECT_EQ(c.travelOrDefault(), usual.travelOrDefault());
  EXPECT_TRUE(c.ordersByTravel());
  EXPECT_TRUE(c.regions.empty() && c.springs.empty());
  for (const auto& absent :
       {c.element_order, c.order, c.force_order, c.modes, c.sweeps, c.load.steps, c.pgd.sweeps})
    EXPECT_FALSE(absent);
  for (const auto& absent :
       {c.patch_radius, c.near_radius, c.travel, c.size_limit, c.load.magnitude, c.pgd.tolerance})
    EXPECT_FALSE(absent);
  EXPECT_EQ(read(caseTemplate("a.msh", true)).accessible, "accessible");
}

TEST_F(CaseKeys, TheTemplateHasEachKeyWithItsUnitAndRange) {
  const std::string text = caseTemplate("organ.msh", false);
  for (const CaseKey& key : caseKeys()) {
    const std::string name = std::string(key.active ? "\n" : "\n# ") + std::string(key.name) + " = ";
    const std::size_t line = text.find(name);
    ASSERT_NE(line, std::string::npos) << key.table << '.' << key.name;
    EXPECT_FALSE(key.help.empty());
  }
  EXPECT_NE(text.find("above 0, at most 0.05 m\n"), std::string::npos) << text;
  EXPECT_NE(text.find("1 to 7\n"), std::string::npos) << text;
}

TEST_F(CaseKeys, TheReaderTakesEachExample) {
  for (const CaseKey& key : caseKeys()) {
    const bool given = key.name == "file" || key.name == "group" || key.name == "stiffness" ||
                       (key.table == "region" && key.name == "E");
    const std::string line = given ? "" : std::string(key.name) + " = " + std::string(key.value) + "\n";
    EXPECT_EQ(refusal(caseWith(key.table, line)), "was taken") << key.table << '.' << key.name;
  }
}

TEST_F(CaseKeys, TheReaderKnowsTheDeclaredKeysAndNoOthers) {
  std::set<std::string> tables;
  for (const CaseKey& key : caseKeys()) tables.emplace(key.table);
  EXPECT_EQ(tables.size(), 9U);
  for (const std::string& table : tables) {
    std::set<std::string> names;
    for (const CaseKey& key : caseKeys())
      if (key.table == table) names.emplace(key.name);
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    EXPECT_NE(refusal(caseWith(table, "zzz = 1\n")).find("zzz is not known here (known: " + known + ")"),
              std::string::npos)
        << refusal(caseWith(table, "zzz = 1\n"));
  }
}

TEST_F(CaseKeys, RefusesNumbersOutsideTheDeclaredRange) {
  for (const CaseKey& key : caseKeys()) {
    if (key.type != CaseKey::Type::kNumber && key.type != CaseKey::Type::kWhole) continue;
    if (key.name == "stiffness" || (key.table == "region" && key.name == "E"))
      continue;  // has to be there once
    const std::string above =
        key.type == CaseKey::Type::kWhole ? std::to_string(static_cast<int>(key.high) + 1) : "1e30";
    EXPECT_NE(
        refusal(caseWith(key.table, std::string(key.name) + " = " + above + "\n")).find("is out of range"),
        std::string::npos)
        << key.table << '.' << key.name;
  }
}

TEST_F(CaseKeys, AKeyThatIsNotDeclaredIsASlip) {
  EXPECT_THROW((void)caseKey("model", "depth"), std::logic_error);
}

}  // namespace
}  // namespace palpate::solver
