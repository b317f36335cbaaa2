// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/pacer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace palpate::rt {
namespace {

TEST(Pacer, WakesNeverBeforeItsTime) {
  const std::int64_t start = monotonicNow();
  Pacer pacer(1'000'000);
  for (int i = 1; i <= 20; ++i) {
    EXPECT_GE(pacer.wait(), 0);
    EXPECT_GE(monotonicNow() - start, i * 1'000'000);
  }
}

TEST(Pacer, SkipsAndCountsWhatItMissed) {
  Pacer pacer(1'000'000);
  pacer.wait();
  const std::uint64_t before = pacer.missed();
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_GE(pacer.wait(), 8'000'000);
  EXPECT_GE(pacer.missed() - before, 8U);
  // No burst makes up for it: the next point lies ahead.
  const std::int64_t woke = monotonicNow();
  pacer.wait();
  pacer.wait();
  EXPECT_GE(monotonicNow() - woke, 1'000'000);
}

}  // namespace
}  // namespace palpate::rt
