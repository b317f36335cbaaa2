// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace palpate {
namespace {

constexpr int kWorkers = 4;

TEST(ParallelFor, DoesEachChunkOnceByAWorkerThatItNames) {
  constexpr std::size_t kChunks = 10'000;
  std::vector<std::atomic<int>> done(kChunks);
  std::atomic<int> strange{0};
  parallelFor(kWorkers, kChunks, [&](int worker, std::size_t chunk) {
    if (worker < 0 || worker >= kWorkers) ++strange;
    ++done[chunk];
  });
  EXPECT_EQ(strange, 0);
  for (const std::atomic<int>& times : done) ASSERT_EQ(times, 1);
}

TEST(ParallelFor, HasTheCallerWorkWhereThereIsNothingForOthers) {
  int done = 0;
  parallelFor(
      1, 3, [&](int worker, std::size_t chunk) { done += worker == 0 ? 1 + static_cast<int>(chunk) : -10; });
  EXPECT_EQ(done, 6);
  parallelFor(kWorkers, 0, [&](int, std::size_t) { done = -1; });
  EXPECT_EQ(done, 6);
}

TEST(ParallelFor, EndsWithTheFirstExceptionOfAWorker) {
  std::atomic<int> begun{0};
  const auto work = [&](int, std::size_t chunk) {
    ++begun;
    if (chunk == 5) throw std::runtime_error("the sixth");
  };
  constexpr int kChunks = 100'000'000;
  try {
    parallelFor(kWorkers, kChunks, work);
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the sixth");
  }
  EXPECT_GE(begun, 6);
  EXPECT_LT(begun, kChunks);
}

TEST(LoadThreads, AreFewAndAtLeastOne) {
  EXPECT_GE(loadThreads(), 1);
  EXPECT_LE(loadThreads(), 4);
}

}  // namespace
}  // namespace palpate
