// SPDX-License-Identifier: Apache-2.0
// palpate-solve, killed and started again.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "palpate/testing/child_process.h"
#include "solved_block.h"

namespace palpate {
namespace {

class KilledSolve : public SolveProgram {
 protected:
  [[nodiscard]] static std::vector<std::string> arguments(const std::string& input, const std::string& output,
                                                          const std::string& threads = "2") {
    return {input, "-o", output, "-q", "--json", "--modes", "20", "--threads", threads};
  }

  /// Starts a solve and kills it once a stage has kept something. @return whether it was still at work
  [[nodiscard]] bool killAt(const std::string& stage) const {
    fs::remove_all(partial());
    fs::remove(folder_ / "out.h5");  // of a try that ended too soon
    testing::ChildProcess solve("palpate-solve", arguments(path("case.toml"), path("out.h5")), {});
    while (solve.running() && !hasKept(stage)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    solve.signal(SIGKILL);
    return solve.waitForExit() == 128 + SIGKILL;
  }
  /// Whether the journal of a stage has something in it; that of edges has the fit in its name.
  [[nodiscard]] bool hasKept(const std::string& stage) const {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(partial(), error))
      if (entry.path().extension() == ".journal" && entry.path().filename().string().rfind(stage, 0) == 0 &&
          entry.file_size(error) > 0 && !error)
        return true;
    return false;
  }
  [[nodiscard]] bool killAtLast(const std::string& stage) const {
    for (int tries = 0; tries < 5; ++tries)
      if (killAt(stage)) return true;
    return false;
  }
  [[nodiscard]] fs::path partial() const { return folder_ / "out.h5.partial"; }
};

TEST_F(KilledSolve, GoesOnToTheSameBits) {
  const std::string input = writeCase("");
  const ProgramResult whole = solve(arguments(input, path("whole.h5")));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_FALSE(nlohmann::json::parse(whole.out).at("seconds").contains("kept"));
  EXPECT_FALSE(fs::exists(folder_ / "whole.h5.partial"));
  // Any number of threads gives these bits, also after those that were killed.
  for (const auto& [stage, threads] : {std::pair("series", "1"), {"greens", "2"}, {"edges", "3"}}) {
    SCOPED_TRACE(stage);
    ASSERT_TRUE(killAtLast(stage)) << "ended before it could be killed, five times";
    EXPECT_FALSE(fs::exists(folder_ / "out.h5"));
    const ProgramResult rest = solve(arguments(input, path("out.h5"), threads));
    ASSERT_EQ(rest.exit_code, 0) << rest.err;
    EXPECT_GT(nlohmann::json::parse(rest.out).at("seconds").at("kept"), 0.0);
    EXPECT_EQ(digest("out.h5"), digest("whole.h5"));
    EXPECT_FALSE(fs::exists(partial()));
    fs::remove(folder_ / "out.h5");
  }
}

TEST_F(KilledSolve, IsNotMixedWithAnotherCase) {
  (void)writeCase("");
  ASSERT_TRUE(killAtLast("series"));
  const std::string changed = writeCase("[material]\nE = 150e3\n");
  expectRefusal(solve(arguments(changed, path("out.h5"))), "material.E is now 150000, was 160000; --fresh");
  EXPECT_TRUE(fs::exists(partial() / "series.journal")) << "what is refused stays";
  std::vector<std::string> fresh = arguments(changed, path("out.h5"));
  fresh.emplace_back("--fresh");
  const ProgramResult result = solve(fresh);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(nlohmann::json::parse(result.out).at("seconds").contains("kept"));
}

TEST_F(KilledSolve, DoesNotTrustSpoiledScratch) {
  const std::string input = writeCase("");
  ASSERT_EQ(solve(arguments(input, path("whole.h5"))).exit_code, 0);
  ASSERT_TRUE(killAtLast("greens"));
  {
    std::fstream scratch(partial() / "series", std::ios::in | std::ios::out | std::ios::binary);
    scratch.seekp(1000);
    scratch.write("spoiled", 7);
  }
  const ProgramResult rest = solve(arguments(input, path("out.h5")));
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(digest("out.h5"), digest("whole.h5"));
}

TEST_F(KilledSolve, IsForTheSeriesMethods) {
  expectRefusal(solve({path("block.msh"), "-o", path("out.h5"), "--method", "pgd-linear", "--fresh"}),
                "--fresh is for the series methods, not pgd-linear");
}

}  // namespace
}  // namespace palpate
