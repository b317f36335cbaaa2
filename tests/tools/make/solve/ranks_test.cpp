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
  [[nodiscard]] static ProgramResult byRanks(int ranks, const std::vector<std::string>& rest) {
    return runProgram("/usr/bin/mpirun", arguments(ranks, rest));
  }
  [[nodiscard]] std::vector<std::string> solved(const std::string& output,
                                                const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{path("case.toml"), "-o", path(output), "-q", "--json", "--modes", "20"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Of a rank that makes out.h5.
  [[nodiscard]] fs::path folderOf(int rank) const {
    return folder_ / ("out.h5.partial" + (rank > 0 ? '.' + std::to_string(rank) : std::string()));
  }
  [[nodiscard]] bool hasKept(int rank) const {
    std::error_code error;
    const auto size = fs::file_size(folderOf(rank) / "series.journal", error);
    return !error && size > 0;
  }
  /// Starts two ranks and kills one of them once both have kept something. @return whether they were still at work
  [[nodiscard]] bool killOne() const {
    for (const auto& entry : fs::directory_iterator(folder_.path()))  // of a try that ended too soon
      if (entry.path().filename().string().rfind("out.", 0) == 0) fs::remove_all(entry.path());
    testing::CaughtOutput err;
    testing::ChildProcess mpirun("/usr/bin/mpirun", arguments(2, solved("out.h5")), {-1, err.descriptor()});
    while (mpirun.running() && !(hasKept(0) && hasKept(1)))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::ifstream ranks("/proc/" + std::to_string(mpirun.pid()) + "/task/" + std::to_string(mpirun.pid()) +
                        "/children");
    pid_t first = 0, second = 0;
    if (ranks >> first >> second) kill(second, SIGKILL);
    const int code = mpirun.waitForExit(std::chrono::seconds(20));
    EXPECT_NE(code, -1) << "hangs: " << err.text();
    if (fs::exists(folder_ / "out.h5") || !fs::exists(folderOf(0)) || !fs::exists(folderOf(1))) return false;
    EXPECT_GT(code, 0) << err.text();
    EXPECT_EQ(err.text().find("palpate-solve: "), std::string::npos) << err.text();
    return true;
  }
  [[nodiscard]] bool killOneAtLast() const {
    for (int tries = 0; tries < 5; ++tries)
      if (killOne()) return true;
    return false;
  }
  /// One line of palpate-solve, from all of its processes; mpirun has words of its own.
  static void expectOneLine(const ProgramResult& result, int code, const std::string& part) {
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("palpate-solve: "), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("palpate-solve: "), result.err.rfind("palpate-solve: ")) << result.err;
  }
};

TEST_F(SolvedByRanks, HasTheBitsOfOneProcess) {
  (void)writeCase("");
  ASSERT_EQ(solve(solved("one.h5", {"--threads", "2"})).exit_code, 0);
  for (const int ranks : {2, 4}) {
    const ProgramResult result = byRanks(ranks, solved("out.h5"));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(digest("out.h5"), digest("one.h5")) << ranks;
    for (int rank = 0; rank < ranks; ++rank) EXPECT_FALSE(fs::exists(folderOf(rank))) << rank;
    fs::remove(folder_ / "out.h5");
  }
}

TEST_F(SolvedByRanks, GoOnToTheSameBits) {
  (void)writeCase("");
  ASSERT_EQ(solve(solved("one.h5")).exit_code, 0);
  ASSERT_TRUE(killOneAtLast()) << "ended before it could be killed, five times";
  EXPECT_FALSE(fs::exists(folder_ / "out.h5"));
  const ProgramResult rest = byRanks(2, solved("out.h5"));
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_GT(nlohmann::json::parse(rest.out).at("seconds").at("kept"), 0.0);
  EXPECT_EQ(digest("out.h5"), digest("one.h5"));
  EXPECT_FALSE(fs::exists(folderOf(1)));
}

TEST_F(SolvedByRanks, AreNotMixedWithAnotherNumber) {
  (void)writeCase("");
  ASSERT_TRUE(killOneAtLast());
  expectRefusal(solve(solved("out.h5")), "processes is now 1, was 2; --fresh");
  expectOneLine(byRanks(3, solved("out.h5")), 1, "processes is now 3, was 2; --fresh");
  EXPECT_FALSE(fs::exists(folderOf(2)));
  // Where only folders of others are left, with a gap before them.
  fs::remove_all(folderOf(0));
  fs::rename(folderOf(1), folderOf(5));
  expectRefusal(solve(solved("out.h5")), "processes is now 1, was 2; --fresh");
  EXPECT_FALSE(fs::exists(folderOf(0))) << "a refused start leaves nothing";
  const ProgramResult fresh = solve(solved("out.h5", {"--fresh"}));
  ASSERT_EQ(fresh.exit_code, 0) << fresh.err;
  EXPECT_FALSE(fs::exists(folderOf(5)));
}

TEST_F(SolvedByRanks, EndTogetherWhereOneIsRefused) {
  (void)writeCase("");
  ASSERT_TRUE(killOneAtLast());
  fs::remove_all(folderOf(0));
  expectOneLine(byRanks(2, solved("out.h5", {"--order", "2"})), 1, "order is now 2, was ");
  EXPECT_FALSE(fs::exists(folderOf(0))) << "a refused start leaves nothing";
  EXPECT_TRUE(fs::exists(folderOf(1))) << "what is refused stays";
}

TEST_F(SolvedByRanks, EndTogetherWhereOneFails) {
  (void)writeCase("");
  ASSERT_TRUE(killOneAtLast());
  fs::remove(folderOf(1) / "series.journal");
  fs::create_directory(folderOf(1) / "series.journal");  // which is no file
  expectOneLine(byRanks(2, solved("out.h5")), 1, "out.h5.partial.1/series.journal");
  EXPECT_FALSE(fs::exists(folder_ / "out.h5"));
}

TEST_F(SolvedByRanks, RefuseWhatIsForOneProcess) {
  (void)writeCase("");
  expectOneLine(byRanks(2, solved("out.h5", {"--dry-run"})), 2,
                "palpate-solve: --dry-run is for one process, not for 2\n");
  expectOneLine(byRanks(2, {"--batch", folder_.path().string()}), 2,
                "palpate-solve: --batch is for one process, not for 2\n");
  expectOneLine(byRanks(1, {"--batch", folder_.path().string()}), 2,
                "palpate-solve: --batch starts its processes itself: start it without a launcher of MPI\n");
  expectOneLine(byRanks(2, {path("case.toml"), "-o", path("out.h5"), "--method", "pgd-linear",
                            "--load-direction", "any"}),
                1, "method pgd-linear is solved by one process, not by 2\n");
  expectOneLine(byRanks(2, {path("case.toml"), "-o", path("out.h5"), "--target", "handheld"}), 1,
                "target handheld is solved by one process, not by 2\n");
}

TEST_F(SolvedByRanks, AnswerTheCommandLineOnce) {
  expectOneLine(byRanks(2, {"--mode", "3"}), 2, "--mode");
  const ProgramResult help = byRanks(2, {"--help"});
  EXPECT_EQ(help.exit_code, 0) << help.err;
  EXPECT_NE(help.out.find("--fresh"), std::string::npos) << help.out;
  EXPECT_EQ(help.out.find("--fresh "), help.out.rfind("--fresh ")) << help.out;
}

TEST_F(SolvedByRanks, RefuseTheLauncherOfAnotherMpi) {
  (void)writeCase("");
  setenv("PMI_SIZE", "2", 1);
  const ProgramResult result = solve(solved("out.h5"));
  unsetenv("PMI_SIZE");
  expectOneLine(result, 2, "the launcher says that there are 2 processes, MPI knows of one");
}

TEST_F(SolvedByRanks, RefuseANumberOfProcessesThatIsNone) {
  (void)writeCase("");
  for (const char* const said : {"x", "2x", "0", "-1", "", "99999999999"}) {
    setenv("PMI_SIZE", said, 1);
    const ProgramResult result = solve(solved("out.h5"));
    unsetenv("PMI_SIZE");
    expectOneLine(result, 2, std::string("PMI_SIZE is '") + said + "'");
  }
}

}  // namespace
}  // namespace palpate
