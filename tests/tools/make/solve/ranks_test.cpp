// SPDX-License-Identifier: Apache-2.0
// palpate-solve by several processes.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "palpate/testing/child_process.h"
#include "palpate/testing/paths.h"
#include "solved_block.h"

namespace palpate {
namespace {

class SolvedByRanks : public SolveProgram {
 protected:
  void SetUp() override {
    if (!PALPATE_HAVE_MPI) GTEST_SKIP() << "this build has no MPI (libopenmpi-dev, PALPATE_MPI)";
    if (!testing::isInstalled("mpirun")) GTEST_SKIP() << "no mpirun here (openmpi-bin)";
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }

  [[nodiscard]] static std::vector<std::string> arguments(int ranks, const std::vector<std::string>& rest) {
    std::vector<std::string> all{"-q",
                                 "-n",
                                 std::to_string(ranks),
                                 "--oversubscribe",
                                 "--bind-to",
                                 "none",
                                 testing::binDir() + "/palpate-solve"};
    all.insert(all.end(), rest.begin(), rest.end());
    return all;
  }
  [[nodiscard]] std::vector<std::string> solved(const std::string& output) const {
    return {path("case.toml"), "-o", path(output), "-q", "--modes", "20", "--threads", "1"};
  }
  [[nodiscard]] std::string digest(const std::string& model) const {
    const ProgramResult result = runProgram("palpate-inspect", {path(model), "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0
               ? nlohmann::json::parse(result.out).at("digest").at("sha256").get<std::string>()
               : model;
  }
};

TEST_F(SolvedByRanks, HasTheBitsOfOneProcess) {
  (void)writeCase("");
  std::vector<std::string> two_threads = solved("one.h5");
  two_threads.back() = "2";
  ASSERT_EQ(solve(two_threads).exit_code, 0);
  for (const int ranks : {2, 4}) {
    const ProgramResult result = runProgram("/usr/bin/mpirun", arguments(ranks, solved("many.h5")));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(digest("many.h5"), digest("one.h5")) << ranks;
    EXPECT_FALSE(fs::exists(folder_ / "many.h5.partial"));
    EXPECT_FALSE(fs::exists(folder_ / "many.h5.partial.1"));
    fs::remove(folder_ / "many.h5");
  }
}

TEST_F(SolvedByRanks, GoOnToTheSameBits) {
  (void)writeCase("");
  ASSERT_EQ(solve(solved("one.h5")).exit_code, 0);
  const auto kept = [&](const char* folder) {
    std::error_code error;
    const auto size = fs::file_size(folder_ / folder / "series.journal", error);
    return !error && size > 0;
  };
  {
    testing::CaughtOutput err;
    testing::ChildProcess mpirun("/usr/bin/mpirun", arguments(2, solved("out.h5")), {-1, err.descriptor()});
    while (mpirun.running() && !(kept("out.h5.partial") && kept("out.h5.partial.1")))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::ifstream ranks("/proc/" + std::to_string(mpirun.pid()) + "/task/" + std::to_string(mpirun.pid()) +
                        "/children");
    pid_t first = 0, second = 0;
    ASSERT_TRUE(ranks >> first >> second) << "ended before it could be killed";
    kill(second, SIGKILL);
    EXPECT_NE(mpirun.waitForExit(std::chrono::seconds(20)), -1) << "hangs";
  }
  ASSERT_TRUE(fs::exists(folder_ / "out.h5.partial.1")) << "ended before it could be killed";
  expectRefusal(solve(solved("out.h5")), "processes is now 1, was 2; --fresh");
  const ProgramResult rest = runProgram("/usr/bin/mpirun", arguments(2, solved("out.h5")));
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(digest("out.h5"), digest("one.h5"));
  EXPECT_FALSE(fs::exists(folder_ / "out.h5.partial.1"));
}

TEST_F(SolvedByRanks, RefuseWhatIsForOneProcess) {
  (void)writeCase("");
  std::vector<std::string> dry = solved("out.h5");
  dry.emplace_back("--dry-run");
  const ProgramResult result = runProgram("/usr/bin/mpirun", arguments(2, dry));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("palpate-solve: --dry-run is for one process, not for 2\n"), std::string::npos)
      << result.err;
  EXPECT_EQ(result.err.find("palpate-solve: "), result.err.rfind("palpate-solve: ")) << result.err;
}

}  // namespace
}  // namespace palpate
