// SPDX-License-Identifier: Apache-2.0
// palpate-solve --batch that is killed, and several at once.
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "palpate/testing/child_process.h"
#include "solved_in_batches.h"

namespace palpate {
namespace {

TEST_F(SolvedInBatches, GoOnAfterOneWhoseProcessIsKilled) {
  addCase("one.toml", slow_);
  addCase("two.toml", quick_);
  testing::CaughtOutput out, err;
  testing::ChildProcess program("palpate-solve", batch(), {out.descriptor(), err.descriptor()});
  const pid_t solver = solverOf(program, "one.h5");
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
    solver = solverOf(program, "two.h5");
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
  for (const char* const file : {"one.h5.lock", "two.h5.partial/solve"}) {
    const int held = open(inCases(file).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    ASSERT_EQ(flock(held, LOCK_EX | LOCK_NB), 0);
  }
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
    std::error_code error;
    const fs::path journal = folder_ / "other/one.h5.partial/series.journal";
    while (program.running() && (!fs::exists(journal) || fs::file_size(journal, error) == 0))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
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

}  // namespace
}  // namespace palpate
