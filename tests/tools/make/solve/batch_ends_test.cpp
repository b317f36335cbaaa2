// SPDX-License-Identifier: Apache-2.0
// palpate-solve --batch that is killed, and several at once.
#include <signal.h>

#include <functional>
#include <stdexcept>

#include "palpate/testing/child_process.h"
#include "solved_in_batches.h"
#include "tools/make/solve/own_process.h"
#include "tools/solver/base/file_lock.h"

namespace palpate {
namespace {

TEST_F(SolvedInBatches, GoOnAfterOneWhoseProcessIsKilled) {
  addCase("one.toml", slow_);
  addCase("two.toml", quick_);
  testing::CaughtOutput out, err;
  testing::ChildProcess program("palpate-solve", batch(), {out.descriptor(), err.descriptor()});
  const pid_t solver = solverOf(program, inCases("one.h5"));
  ASSERT_GT(solver, 0) << err.text();
  kill(solver, SIGKILL);
  EXPECT_EQ(program.waitForExit(), 1) << err.text();
  const json report = json::parse(out.text());
  EXPECT_EQ(statesOf(report), (States{{"one.toml", "failed"}, {"two.toml", "solved"}}));
  EXPECT_EQ(entryOf(report, "one.toml").at("error"),
            "its process was ended by signal 9, Killed: was there too little memory?");
  const json rest = solved(0);
  EXPECT_EQ(statesOf(rest), (States{{"one.toml", "solved"}, {"two.toml", "there"}}));
  EXPECT_GT(entryOf(rest, "one.toml").at("solve").at("seconds").at("kept"), 0.0);
  EXPECT_EQ(leftOvers(), std::vector<std::string>());
}

TEST_F(SolvedInBatches, GoOnWhereTheyWereKilled) {
  addCase("one.toml", quick_);
  addCase("two.toml", slow_);
  pid_t solver = 0;
  {
    testing::CaughtOutput err;
    testing::ChildProcess program("palpate-solve", batch(), {-1, err.descriptor()});
    solver = solverOf(program, inCases("two.h5"));
    ASSERT_GT(solver, 0) << err.text();
    program.signal(SIGKILL);
    EXPECT_EQ(program.waitForExit(), 128 + SIGKILL);
  }
  EXPECT_FALSE(fs::exists(inCases("two.h5")));
  const json rest = solved(0);
  EXPECT_EQ(statesOf(rest), (States{{"one.toml", "there"}, {"two.toml", "solved"}}))
      << "the solver ends with its batch";
  EXPECT_GT(entryOf(rest, "two.toml").at("solve").at("seconds").at("kept"), 0.0);
  ASSERT_EQ(solve({inCases("two.toml"), "-o", path("single.h5"), "-q"}).exit_code, 0);
  EXPECT_EQ(digest("cases/two.h5"), digest("single.h5"));
  EXPECT_EQ(leftOvers(), std::vector<std::string>());
}

TEST_F(SolvedInBatches, AreSharedByWorkers) {
  const std::vector<std::string> names{"a.toml", "b.toml", "c.toml", "d.toml", "e.toml"};
  for (const std::string& name : names) addCase(name, quick_);
  std::vector<std::string> first = batch({"--worker", "1/2"});
  first.insert(first.end(), {"--order", "1"});
  testing::CaughtOutput out;
  testing::ChildProcess one("palpate-solve", first, {out.descriptor(), -1});
  const json second = solved(0, {"--worker", "2/2", "--order", "1"});
  ASSERT_EQ(one.waitForExit(), 0);
  EXPECT_EQ(statesOf(json::parse(out.text())),
            (States{{"a.toml", "solved"}, {"c.toml", "solved"}, {"e.toml", "solved"}}));
  EXPECT_EQ(statesOf(second), (States{{"b.toml", "solved"}, {"d.toml", "solved"}}));
  EXPECT_EQ(second.at("worker"), "2/2");
  EXPECT_TRUE(solved(0, {"--worker", "9/9", "--order", "1"}).at("cases").empty());
}

TEST_F(SolvedInBatches, AreNeverSolvedTwiceAtOnce) {
  addCase("one.toml", quick_);
  addCase("two.toml", quick_);
  // Another batch, whose scratch is elsewhere; a single solve in the same folder.
  fs::create_directory(inCases("two.h5.partial"));
  const auto one = solver::FileLock::take(inCases("one.h5.lock")),
             two = solver::FileLock::take(inCases("two.h5.partial/solve"));
  ASSERT_TRUE(one && two);
  const json report = solved(0);
  EXPECT_EQ(statesOf(report), (States{{"one.toml", "elsewhere"}, {"two.toml", "elsewhere"}}));
  EXPECT_FALSE(fs::exists(inCases("one.h5")) || fs::exists(inCases("two.h5")));
}

TEST_F(SolvedInBatches, AreMadeWholeAfterAKillBesideTheModel) {
  addCase("one.toml", slow_);
  ASSERT_EQ(solved(0).at("solved"), 1);
  const auto written = fs::last_write_time(inCases("one.h5"));
  // As if killed before its scratch was removed: that of a second solve of the case.
  fs::create_directory(folder_ / "other");
  {
    testing::ChildProcess program("palpate-solve", {inCases("one.toml"), "-o", path("other/one.h5"), "-q"},
                                  {});
    waitForParts(program, path("other/one.h5"));
    ASSERT_TRUE(stopped(program.pid(), path("other/one.h5")));
    program.signal(SIGKILL);
    ASSERT_EQ(program.waitForExit(), 128 + SIGKILL);
  }
  fs::rename(folder_ / "other/one.h5.partial", inCases("one.h5.partial"));
  fs::remove(inCases("one.xdmf"));
  EXPECT_EQ(solved(0).at("there"), 1);
  EXPECT_TRUE(fs::exists(inCases("one.xdmf")));
  EXPECT_EQ(leftOvers(), std::vector<std::string>());
  EXPECT_EQ(fs::last_write_time(inCases("one.h5")), written);
}

TEST_F(SolvedInBatches, LeaveThePartsOfAnotherCaseBesideTheModel) {
  addCase("one.toml", quick_);
  ASSERT_EQ(solved(0).at("solved"), 1);
  fs::create_directory(inCases("one.h5.partial"));
  std::ofstream(inCases("one.h5.partial/solve")) << "palpate-solve checkpoint 1\nmaterial.E = 1\n";
  std::ofstream(inCases("one.h5.partial/series.journal")) << "an hour of work";
  fs::remove(inCases("one.xdmf"));
  const ProgramResult result = solve(batch());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out).at("there"), 1);
  EXPECT_NE(
      result.err.find("warning: " + inCases("one.h5.partial").string() + " holds parts of another solve"),
      std::string::npos)
      << result.err;
  EXPECT_EQ(testing::contentOf(inCases("one.h5.partial/series.journal")), "an hour of work");
  EXPECT_TRUE(fs::exists(inCases("one.xdmf")));
}

TEST_F(SolvedInBatches, FailWhereTheFolderOfTheirModelsIsGone) {
  addCase("one.toml", slow_);
  addCase("two.toml", quick_);
  testing::CaughtOutput out, err;
  testing::ChildProcess program("palpate-solve", batch({"-o", path("models")}),
                                {out.descriptor(), err.descriptor()});
  const pid_t solver = solverOf(program, path("models/one.h5"));
  ASSERT_GT(solver, 0) << err.text();
  fs::remove_all(folder_ / "models");
  kill(solver, SIGKILL);
  EXPECT_EQ(program.waitForExit(), 1) << err.text();
  const json report = json::parse(out.text());
  EXPECT_EQ(statesOf(report), (States{{"one.toml", "failed"}, {"two.toml", "failed"}}));
  EXPECT_EQ(entryOf(report, "two.toml").at("error"), path("models") + ": the folder of the models is gone");
}

TEST_F(SolvedInBatches, ShareAScratchFolderWithTheSameNamesOfAnotherFolder) {
  addCase("one.toml", quick_);
  fs::create_directories(folder_ / "scratch/one.h5.partial");
  fs::create_directory(folder_ / "models");
  const std::vector<std::string> here{"--scratch", path("scratch")},
      there{"--scratch", path("scratch"), "-o", path("models")};
  const fs::path held = folder_ / "scratch/one.h5.partial/solve";
  {
    const auto other = solver::FileLock::take(held);
    const json refused = solved(1, here);
    EXPECT_EQ(statesOf(refused), (States{{"one.toml", "failed"}}));
    const auto error = entryOf(refused, "one.toml").at("error").get<std::string>();
    EXPECT_NE(error.find("one.h5.partial: another program solves there"), std::string::npos) << error;
  }
  EXPECT_EQ(solved(0, here).at("solved"), 1);
  EXPECT_EQ(solved(0, there).at("solved"), 1);
  EXPECT_EQ(digest("cases/one.h5"), digest("models/one.h5"));
  EXPECT_TRUE(fs::is_empty(folder_ / "scratch"));
  EXPECT_EQ(leftOvers(), std::vector<std::string>());
  // The other folder's case is solved again: what it keeps there is not for this folder to remove.
  fs::create_directory(folder_ / "scratch/one.h5.partial");
  const auto other = solver::FileLock::take(held);
  ASSERT_TRUE(other);
  fs::remove(inCases("one.xdmf"));
  EXPECT_EQ(solved(0, here).at("there"), 1);
  EXPECT_TRUE(fs::exists(inCases("one.xdmf")) && fs::exists(held));
}

TEST(OwnProcess, KeepsAnExceptionFromItsParent) {
  const auto ran = [](const std::function<program::Json()>& work) -> std::string {
    try {
      return solve_program::inOwnProcess(work).text();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(ran([] { return program::Json("done"); }), "done");
  EXPECT_EQ(ran([]() -> program::Json { throw std::runtime_error("of the work"); }),
            "its process was ended by signal 6, Aborted");
}

}  // namespace
}  // namespace palpate
