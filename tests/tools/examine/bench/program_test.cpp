// SPDX-License-Identifier: Apache-2.0
// palpate-bench as its own process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "palpate/testing/run_program.h"
#include "palpate/testing/synthetic_model.h"

namespace palpate::testing {

namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

ProgramResult bench(const std::vector<std::string>& arguments) {
  return runProgram("palpate-bench", arguments);
}

/// By name, what a short run reports.
std::map<std::string, nlohmann::json> measured(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--benchmark_format=json", "--benchmark_min_time=0.01"});
  const ProgramResult run = bench(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::map<std::string, nlohmann::json> found;
  const auto json = nlohmann::json::parse(run.out);
  for (const auto& one : json["benchmarks"]) found[one["name"]] = one;
  return found;
}

}  // namespace

TEST(Bench, EachSizeIsThereWithItsMeasures) {
  const std::string names = bench({"--benchmark_list_tests"}).out;
  for (const char* size : {"500x20", "500x300", "2009x167", "20000x100", "50000x300"})
    for (const char* who : {"palpate", "eigen_f32", "plain_read"})
      EXPECT_THAT(names, HasSubstr(std::string("field/") + size + "/" + who + "\n"));
}

TEST(Bench, FieldReportsTimesBytesAndTheErrorOfItsStorage) {
  auto found = measured({"--benchmark_filter=field/2009x167/"});
  ASSERT_EQ(found.size(), 3U);
  for (const auto& [name, one] : found) {
    EXPECT_GT(one["p50_us"], 0.0) << name;
    EXPECT_GE(one["p99_us"], one["p50_us"]) << name;
  }
  const auto& palpate = found["field/2009x167/palpate"];
  EXPECT_GT(palpate["error_max"], 0.0);
  EXPECT_LT(palpate["error_max"], 1e-3);
  const double float32 = 2009.0 * 3.0 * 167.0 * 4.0;
  EXPECT_EQ(found["field/2009x167/eigen_f32"]["bytes"], float32);
  EXPECT_GT(found["field/2009x167/eigen_f32"]["error_max"], 0.0);
  EXPECT_LT(found["field/2009x167/eigen_f32"]["error_max"], 1e-4);
  EXPECT_EQ(found["field/2009x167/plain_read"]["bytes"], palpate["bytes"]) << "the same bytes";
  EXPECT_LE(palpate["bytes"], float32);
}

TEST(Bench, StepAndLoadUseTheModelGiven) {
  const TemporaryFile file("bench.h5");
  writeSyntheticModel(file.path(), {.subdivisions = 3, .modes = 8});
  auto found = measured({file.path().string(), "--benchmark_filter=step|load"});
  ASSERT_EQ(found.size(), 4U);
  for (const char* name :
       {"step/default/one_tool", "step/default/two_tools", "step/default/four_tools", "load/default"}) {
    ASSERT_TRUE(found.contains(name)) << name;
    EXPECT_GT(found[name]["p50_us"], 0.0);
    EXPECT_GE(found[name]["p99_us"], found[name]["p50_us"]);
  }
  EXPECT_EQ(found["load/default"]["bytes"], std::filesystem::file_size(file.path()));
  EXPECT_GT(found["step/default/one_tool"]["in_contact"], 0.8);
  EXPECT_GT(found["step/default/one_tool"]["field_p50_us"], 0.0);
}

TEST(Bench, CadenceTicksAtTheRateAskedFor) {
  const TemporaryFile file("bench.h5");
  writeSyntheticModel(file.path(), {.subdivisions = 3, .modes = 8});
  auto found = measured({file.path().string(), "--rate", "10000", "--benchmark_filter=cadence"});
  ASSERT_EQ(found.size(), 3U);
  for (const auto& [name, one] : found) {
    EXPECT_GT(one["p50_us"], 0.0) << name;
    EXPECT_GE(one["p99_us"], one["p50_us"]) << name;
    EXPECT_GT(one["in_contact"], 0.8) << name;
  }
}

TEST(Bench, ScaleNamesTheLargestModelThatFits) {
  const ProgramResult run = bench({"--scale", "--modes", "20"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("    20000     20 "));
  EXPECT_THAT(run.out,
              MatchesRegex("(.|\n)*largest at 1 kHz: [0-9]+ surface nodes x 20 modes with near field\n"));
}

TEST(Bench, RunsWithThePriorityOfTheTickOrSaysThatItMayNot) {
  const ProgramResult run = bench({"--realtime", "--benchmark_list_tests"});
  if (run.exit_code == 0) return;
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("palpate-bench: --realtime: SCHED_FIFO 80 is not granted"));
}

TEST(Bench, RefusesAProcessorAndAModelThatAreNotThere) {
  const ProgramResult cpu = bench({"--cpu", "1000", "--benchmark_list_tests"});
  EXPECT_EQ(cpu.exit_code, 2);
  EXPECT_THAT(cpu.err, HasSubstr("palpate-bench: --cpu is 1000, where this process may not run"));
  const ProgramResult model = bench({"/no/such.h5", "--benchmark_list_tests"});
  EXPECT_EQ(model.exit_code, 1);
  EXPECT_THAT(model.err, HasSubstr("/no/such.h5"));
}

}  // namespace palpate::testing
