// SPDX-License-Identifier: Apache-2.0
// The scripts for Slurm, run by bash with the variables that Slurm sets, beside a scontrol that writes down what it is asked.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "palpate/testing/child_process.h"
#include "palpate/testing/paths.h"
#include "solved_block.h"

namespace palpate {
namespace {

using nlohmann::json;

class SolvedBySlurm : public SolveProgram {
 protected:
  SolvedBySlurm() {
    fs::create_directory(folder_ / "cases");
    fs::create_directory(folder_ / "bin");
    std::ofstream(folder_ / "bin/scontrol") << "#!/bin/sh\necho \"$@\" >>'" << path("asked") << "'\n";
    fs::permissions(folder_ / "bin/scontrol", fs::perms::owner_all);
    setenv("PATH", (path("bin") + ":" + testing::binDir() + ":" + getenv("PATH")).c_str(), 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1);
  }

  /// One job of a machine: this one.
  static void beJob(int tasks) {
    std::array<char, 256> host{};
    gethostname(host.data(), host.size() - 1);
    for (const char* const name : {"SLURM_JOB_ID", "SLURM_JOBID"}) setenv(name, "77", 1);
    for (const char* const name : {"SLURM_NODELIST", "SLURM_JOB_NODELIST"}) setenv(name, host.data(), 1);
    for (const char* const name : {"SLURM_NNODES", "SLURM_JOB_NUM_NODES", "SLURM_CPUS_PER_TASK"})
      setenv(name, "1", 1);
    for (const char* const name : {"SLURM_TASKS_PER_NODE", "SLURM_NTASKS"})
      setenv(name, std::to_string(tasks).c_str(), 1);
  }
  /// Task `id` of an array.
  static void beTask(int id, int least, int most, int count) {
    beJob(1);
    const std::map<const char*, int> variables{{"SLURM_ARRAY_TASK_ID", id},
                                               {"SLURM_ARRAY_TASK_MIN", least},
                                               {"SLURM_ARRAY_TASK_MAX", most},
                                               {"SLURM_ARRAY_TASK_COUNT", count}};
    for (const auto& [name, value] : variables) setenv(name, std::to_string(value).c_str(), 1);
    setenv("SLURM_ARRAY_JOB_ID", "77", 1);
  }
  [[nodiscard]] static std::vector<std::string> script(const std::string& name,
                                                       const std::vector<std::string>& rest) {
    std::vector<std::string> all{std::string(PALPATE_SLURM_SCRIPTS) + "/" + name};
    all.insert(all.end(), rest.begin(), rest.end());
    return all;
  }
  void addCase(const std::string& name, const std::string& rest) const {
    std::ofstream(folder_ / "cases" / name) << "mesh = \"../block.msh\"\n" << rest;
  }
  /// Starts a script, tells it that its time ends once the model has been begun, and waits.
  void expectThatItGoesBackIntoTheQueue(const std::vector<std::string>& words, const fs::path& partial,
                                        int exit_code) const {
    testing::CaughtOutput err;
    testing::ChildProcess job("/bin/bash", words, {err.descriptor(), err.descriptor()},
                              testing::ChildProcess::Kills::kGroup);
    std::error_code error;
    while (job.running() && !(fs::file_size(partial / "series.journal", error) > 0 && !error))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    job.signal(SIGUSR1);
    EXPECT_EQ(job.waitForExit(), exit_code) << err.text();
    EXPECT_TRUE(fs::exists(partial / "series.journal")) << err.text();
  }

  const std::string slow_ = "[model]\nmodes = 60\norder = 6\nsweeps = 40\n";
  const std::string quick_ = "[model]\nmodes = 20\norder = 2\n";
};

/// Those that need mpirun.
class SolvedBySlurmAndMpi : public SolvedBySlurm {
 protected:
  void SetUp() override {
    if (!PALPATE_HAVE_MPI) GTEST_SKIP() << "this build has no MPI (libopenmpi-dev, PALPATE_MPI)";
    if (!testing::isInstalled("mpirun")) GTEST_SKIP() << "no mpirun here (openmpi-bin)";
  }
};

TEST_F(SolvedBySlurmAndMpi, HasTheBitsOfOneProcess) {
  const std::string input = writeCase(quick_);
  ASSERT_EQ(solve({input, "-o", path("one.h5"), "-q"}).exit_code, 0);
  beJob(2);
  const ProgramResult job =
      runProgram("/bin/bash", script("solve.sbatch", {input, "-o", path("out.h5"), "--json", "-q"}));
  ASSERT_EQ(job.exit_code, 0) << job.err;
  EXPECT_EQ(json::parse(job.out).at("model"), path("out.h5"));
  EXPECT_EQ(digest("out.h5"), digest("one.h5"));
}

TEST_F(SolvedBySlurmAndMpi, GoesBackIntoTheQueueAndOn) {
  const std::string input = writeCase(slow_);
  beJob(2);
  const std::vector<std::string> words =
      script("solve.sbatch", {input, "-o", path("out.h5"), "--json", "-q"});
  expectThatItGoesBackIntoTheQueue(words, folder_ / "out.h5.partial", 0);
  EXPECT_EQ(testing::contentOf(folder_ / "asked"), "requeue 77\n");
  EXPECT_TRUE(fs::exists(folder_ / "out.h5.partial.1")) << "two processes were at work";
  const ProgramResult rest = runProgram("/bin/bash", words);
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_GT(json::parse(rest.out).at("seconds").at("kept"), 0.0);
}

TEST_F(SolvedBySlurmAndMpi, FailsWithItsSolve) {
  beJob(2);
  const ProgramResult job = runProgram("/bin/bash", script("solve.sbatch", {path("none.toml"), "-q"}));
  EXPECT_EQ(job.exit_code, 1) << job.err;
  EXPECT_NE(job.err.find("none.toml"), std::string::npos) << job.err;
  EXPECT_FALSE(fs::exists(folder_ / "asked"));
}

TEST_F(SolvedBySlurm, SharesABatchAmongTheTasksOfAnArray) {
  for (const char* const name : {"a.toml", "b.toml", "c.toml"}) addCase(name, quick_);
  const std::vector<std::string> words =
      script("batch.sbatch", {path("cases"), "-o", path("models"), "--json", "-q"});
  beTask(1, 1, 2, 2);
  testing::CaughtOutput out;
  testing::ChildProcess first("/bin/bash", words, {out.descriptor(), -1});
  beTask(2, 1, 2, 2);
  const ProgramResult second = runProgram("/bin/bash", words);
  ASSERT_EQ(second.exit_code, 0) << second.err;
  ASSERT_EQ(first.waitForExit(), 0);
  EXPECT_EQ(json::parse(out.text()).at("solved"), 2);
  EXPECT_EQ(json::parse(second.out).at("worker"), "2/2");
  EXPECT_EQ(json::parse(second.out).at("solved"), 1);
  for (const char* const name : {"a.h5", "b.h5", "c.h5"}) EXPECT_TRUE(fs::exists(folder_ / "models" / name));
}

TEST_F(SolvedBySlurm, PutsATaskBackIntoTheQueueAndOn) {
  addCase("a.toml", slow_);
  beTask(1, 1, 1, 1);
  const std::vector<std::string> words = script("batch.sbatch", {path("cases"), "--json", "-q"});
  expectThatItGoesBackIntoTheQueue(words, folder_ / "cases/a.h5.partial", 0);
  EXPECT_EQ(testing::contentOf(folder_ / "asked"), "requeue 77_1\n");
  const ProgramResult rest = runProgram("/bin/bash", words);
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_GT(json::parse(rest.out).at("cases").at(0).at("solve").at("seconds").at("kept"), 0.0);
}

TEST_F(SolvedBySlurm, EndsWhereItsSolveEndsAsTheSignalComes) {
  for (const char* const name : {"palpate-solve", "mpirun"}) {
    std::ofstream(folder_ / "bin" / name)
        << "#!/bin/sh\ntrap 'exit 0' TERM\ntouch '" << path("begun") << "'\nwhile :; do sleep 0.02; done\n";
    fs::permissions(folder_ / "bin" / name, fs::perms::owner_all);
  }
  beTask(1, 1, 1, 1);
  for (const char* const name : {"batch.sbatch", "solve.sbatch"}) {
    testing::ChildProcess job("/bin/bash", script(name, {path("cases")}), {},
                              testing::ChildProcess::Kills::kGroup);
    while (job.running() && !fs::exists(folder_ / "begun"))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    job.signal(SIGUSR1);
    EXPECT_EQ(job.waitForExit(), 0);
    EXPECT_TRUE(fs::remove(folder_ / "begun"));
    EXPECT_FALSE(fs::exists(folder_ / "asked")) << name;
  }
}

TEST_F(SolvedBySlurm, GivesUpATaskThatNeverEnds) {
  addCase("a.toml", slow_);
  beTask(1, 1, 1, 1);
  setenv("SLURM_RESTART_COUNT", "50", 1);
  expectThatItGoesBackIntoTheQueue(script("batch.sbatch", {path("cases"), "-q"}),
                                   folder_ / "cases/a.h5.partial", 1);
  unsetenv("SLURM_RESTART_COUNT");
  EXPECT_FALSE(fs::exists(folder_ / "asked"));
}

TEST_F(SolvedBySlurm, WantsToKnowTheSharesOfAnArrayInPart) {
  for (const char* const name : {"a.toml", "b.toml", "c.toml"}) addCase(name, quick_);
  beTask(3, 2, 3, 2);
  const std::vector<std::string> words = script("batch.sbatch", {path("cases"), "--json", "-q"});
  const ProgramResult unknown = runProgram("/bin/bash", words);
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("SHARES"), std::string::npos) << unknown.err;
  setenv("SHARES", "3", 1);
  const ProgramResult known = runProgram("/bin/bash", words);
  unsetenv("SHARES");
  ASSERT_EQ(known.exit_code, 0) << known.err;
  EXPECT_EQ(json::parse(known.out).at("worker"), "3/3");
  EXPECT_TRUE(fs::exists(folder_ / "cases/c.h5"));
}

TEST_F(SolvedBySlurm, FailsWithItsCases) {
  addCase("a.toml", "[material]\nF = 1\n");
  beTask(1, 1, 1, 1);
  const ProgramResult task = runProgram("/bin/bash", script("batch.sbatch", {path("cases"), "-q"}));
  EXPECT_EQ(task.exit_code, 1) << task.err;
  EXPECT_NE(task.err.find("error: a.toml: "), std::string::npos) << task.err;
}

}  // namespace
}  // namespace palpate
