// SPDX-License-Identifier: Apache-2.0
// What palpate-solve says to somebody who begins: a case file with every key, and sizes that look like slips of unit.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "solved_block.h"

namespace palpate {
namespace {

/// What a solve takes is the same.
nlohmann::json chosenOf(const ProgramResult& result) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  return {json.at("order"), json.at("force_order"), json.at("modes"), json.at("file_bytes")};
}

TEST_F(SolveProgram, WritesACaseThatSolvesAsTheBareMesh) {
  const ProgramResult written = solve({path("block.msh"), "--template", "-o", path("mine.toml")});
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_EQ(written.out, "");
  EXPECT_NE(testing::contentOf(path("mine.toml")).find("\nfile = \"block.msh\""), std::string::npos);
  EXPECT_NE(testing::contentOf(path("mine.toml")).find("\naccessible = \"accessible\""), std::string::npos);
  EXPECT_EQ(chosenOf(solve({path("mine.toml"), "--dry-run", "--json", "-q"})),
            chosenOf(solve({path("block.msh"), "--dry-run", "--json", "-q"})));
}

TEST_F(SolveProgram, WritesACaseWithoutAMesh) {
  const ProgramResult result = solve({"--template"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("\nfile = \"organ.msh\""), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("\n# accessible = \"accessible\""), std::string::npos) << result.out;
  const ProgramResult nothing = solve({});
  EXPECT_EQ(nothing.exit_code, 2);
  testing::expectOneLineError(nothing, "input is required");
  testing::expectOneLineError(solve({path("none.msh"), "--template"}), "none.msh");
}

TEST_F(SolveProgram, WarnsOfAModulusInAnotherUnit) {
  const ProgramResult result = solve({writeCase("[material]\nE = 160\n"), "--dry-run", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(
                "warning: material.E = 160 Pa is softer than any organ (1e3 to 1e6 Pa); in kPa it would be "
                "1.6e+05 Pa\n"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(solve({path("block.msh"), "--dry-run", "-q"}).err.find("warning: "), std::string::npos);
}

TEST_F(SolveProgram, WarnsOfAnOrganInAnotherUnit) {
  mesh::TetMesh block = mesh::makeBox({60.0, 50.0, 40.0}, {5, 4, 4});
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(block.nodes.size()); ++node)
    block.groups[block.nodes[static_cast<std::size_t>(node)].x() < 1e-9 ? "fixed" : "accessible"].push_back(
        node);
  writeBlock("block.msh", block);
  const ProgramResult result = solve({path("block.msh"), "-o", path("out.h5"), "--dry-run", "-q"});
  EXPECT_NE(
      result.err.find(
          "warning: the organ is 60 m long, expected 5 mm to 1 m; a mesh is in metres; in centimetres it "
          "would be 600 mm: palpate-organ import --unit cm; in millimetres it would be 60 mm: "
          "palpate-organ import --unit mm\n"),
      std::string::npos)
      << result.err;
}

TEST_F(SolveProgram, WarnsOfAPatchThatIsMostOfTheOrgan) {
  mesh::TetMesh block = mesh::makeBox({0.18, 0.12, 0.12}, {4, 3, 3});
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(block.nodes.size()); ++node)
    block.groups[block.nodes[static_cast<std::size_t>(node)].x() < 1e-9 ? "fixed" : "accessible"].push_back(
        node);
  writeBlock("block.msh", block);
  const ProgramResult result = solve({path("block.msh"), "-o", path("out.h5"), "--dry-run", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("warning: the contact patch has a radius of 48 mm on an organ whose smallest "
                            "side is 120 mm, with "),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("smaller elements, or a model.patch_radius, would be a tool's"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate
