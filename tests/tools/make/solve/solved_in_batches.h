// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "palpate/testing/child_process.h"
#include "solved_block.h"

namespace palpate {

using nlohmann::json;

/// A folder of cases of the block.
class SolvedInBatches : public SolveProgram {
 protected:
  SolvedInBatches() { fs::create_directory(folder_ / "cases"); }

  void addCase(const std::string& name, const std::string& rest) const {
    std::ofstream(folder_ / "cases" / name) << "mesh = \"../block.msh\"\n" << rest;
  }
  [[nodiscard]] std::vector<std::string> batch(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"--batch", path("cases"), "--json", "-q", "--threads", "2"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Solves the batch. @return its JSON
  [[nodiscard]] json solved(int exit_code, const std::vector<std::string>& more = {}) const {
    const ProgramResult result = solve(batch(more));
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    return json::parse(result.out);
  }
  [[nodiscard]] fs::path inCases(const std::string& name) const { return folder_ / "cases" / name; }
  [[nodiscard]] static std::map<std::string, std::string> statesOf(const json& report) {
    std::map<std::string, std::string> states;
    for (const json& one : report.at("cases")) states[one.at("case")] = one.at("state");
    return states;
  }
  [[nodiscard]] static json entryOf(const json& report, const std::string& name) {
    for (const json& one : report.at("cases"))
      if (one.at("case") == name) return one;
    return {};
  }
  /// Whatever is in the folder of cases beside cases, models and their .xdmf.
  [[nodiscard]] std::vector<std::string> leftOvers() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / "cases"))
      if (const std::string end = entry.path().extension(); end != ".toml" && end != ".h5" && end != ".xdmf")
        names.push_back(entry.path().filename());
    return names;
  }
  /// Waits until a solve has kept something.
  static void waitForParts(testing::ChildProcess& program, const fs::path& model) {
    const fs::path journal = fs::path(model.string() + ".partial") / "series.journal";
    std::error_code error;
    while (program.running() && (!fs::exists(journal) || fs::file_size(journal, error) == 0))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  /// Stops a process that solves, for good. @return whether it was still at work
  [[nodiscard]] static bool stopped(pid_t solver, const fs::path& model) {
    if (solver <= 0 || kill(solver, SIGSTOP) != 0) return false;
    std::string name;
    char state = 0;
    while (std::ifstream("/proc/" + std::to_string(solver) + "/stat") >> solver >> name >> state &&
           state != 'T' && state != 'Z')
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return state == 'T' && !fs::exists(model);
  }
  /// The process that solves the present case, stopped once that has kept something. @return 0: it ended too soon
  [[nodiscard]] static pid_t solverOf(testing::ChildProcess& batch, const fs::path& model) {
    waitForParts(batch, model);
    const std::string task = "/proc/" + std::to_string(batch.pid()) + "/task/" + std::to_string(batch.pid());
    pid_t solver = 0;
    std::ifstream(task + "/children") >> solver;
    return stopped(solver, model) ? solver : 0;
  }

  using States = std::map<std::string, std::string>;
  const std::string quick_ = "[model]\nmodes = 20\norder = 2\n";
  const std::string slow_ =
      "[model]\nmodes = 60\norder = 6\nsweeps = 40\n";  ///< its parts are seen long before its end
};

}  // namespace palpate
