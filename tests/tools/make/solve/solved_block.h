// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/topology.h"
#include "tools/mesh/write_msh.h"

namespace palpate {

namespace fs = std::filesystem;
using testing::ProgramResult;
using testing::runProgram;

/// A folder with a small block and a case, gone afterwards.
class SolveProgram : public ::testing::Test {
 protected:
  SolveProgram() {
    mesh::TetMesh block = mesh::makeBox({0.06, 0.05, 0.04}, {5, 4, 4});
    for (std::int32_t node = 0; node < static_cast<std::int32_t>(block.nodes.size()); ++node) {
      const bool held = block.nodes[static_cast<std::size_t>(node)].x() < 1e-9;
      block.groups[held ? "fixed" : "accessible"].push_back(node);
    }
    writeBlock("block.msh", block);
  }

  void writeBlock(const std::string& name, mesh::TetMesh block) const {
    const mesh::BoundarySurface boundary = mesh::boundaryOf(block);
    for (auto& [group, nodes] : block.groups) {
      std::vector<std::int32_t> kept;
      std::set_intersection(nodes.begin(), nodes.end(), boundary.nodes.begin(), boundary.nodes.end(),
                            std::back_inserter(kept));
      nodes = kept;
    }
    mesh::writeMsh(folder_ / name, block, boundary);
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string writeCase(const std::string& rest) const {
    std::ofstream(folder_ / "case.toml") << "mesh = \"block.msh\"\n" << rest;
    return path("case.toml");
  }
  [[nodiscard]] ProgramResult solve(std::vector<std::string> arguments) const {
    return runProgram("palpate-solve", std::move(arguments));
  }

  /// Of a model's content.
  [[nodiscard]] std::string digest(const std::string& model) const {
    const ProgramResult result = runProgram("palpate-inspect", {path(model), "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0
               ? nlohmann::json::parse(result.out).at("digest").at("sha256").get<std::string>()
               : model;
  }

  void expectRefusal(const ProgramResult& result, const std::string& part) const {
    EXPECT_GT(result.exit_code, 0);
    EXPECT_TRUE(result.out.empty()) << result.out;
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
    EXPECT_EQ(result.err.rfind("palpate-solve: ", 0), 0U) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(folder_ / "out.h5"));
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      EXPECT_EQ(entry.path().filename().string().find("tmp"), std::string::npos) << entry.path();
  }

  const testing::TemporaryFolder folder_;
};

}  // namespace palpate
