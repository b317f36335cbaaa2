// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/latest_value.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

namespace palpate::client {
namespace {

using Block = std::array<std::uint64_t, 48>;

// The wrong twin: one slot, each word an atomic so that ThreadSanitizer has nothing to say, the whole not.
class TornValue {
 public:
  void store(const Block& block) noexcept {
    for (std::size_t i = 0; i < block.size(); ++i) slot_[i].store(block[i], std::memory_order_relaxed);
  }
  [[nodiscard]] bool load(Block& block) noexcept {
    for (std::size_t i = 0; i < block.size(); ++i) block[i] = slot_[i].load(std::memory_order_relaxed);
    return true;
  }

 private:
  std::array<std::atomic<std::uint64_t>, 48> slot_{};
};

struct Seen {
  std::uint64_t torn{0};
  std::uint64_t backwards{0};
  std::uint64_t values{0};
};

// Writes blocks of equal numbers as fast as possible; reads until `enough` says so or the writer is done.
template <class Value>
Seen race(bool (*enough)(const Seen&)) {
  Value value;
  std::atomic<bool> stop{false};
  std::thread writer([&] {
    Block block{};
    for (std::uint64_t n = 1; n <= 20'000'000 && !stop.load(std::memory_order_relaxed); ++n) {
      block.fill(n);
      value.store(block);
    }
    stop.store(true, std::memory_order_relaxed);
  });
  Seen seen;
  Block block{};
  std::uint64_t last = 0;
  while (!enough(seen) && !stop.load(std::memory_order_relaxed)) {
    if (!value.load(block)) continue;
    ++seen.values;
    if (!std::all_of(block.begin(), block.end(), [&](auto n) { return n == block[0]; })) ++seen.torn;
    if (block[0] < last) ++seen.backwards;
    last = block[0];
  }
  stop.store(true, std::memory_order_relaxed);
  writer.join();
  return seen;
}

TEST(LatestValue, ReaderNeverSeesATornOrOlderValue) {
  const Seen seen = race<LatestValue<Block>>([](const Seen& s) { return s.values >= 50'000; });
  EXPECT_GT(seen.values, 0U);
  EXPECT_EQ(seen.torn, 0U);
  EXPECT_EQ(seen.backwards, 0U);
}

TEST(LatestValue, TheCheckCatchesATornValue) {
  const Seen seen = race<TornValue>([](const Seen& s) { return s.torn > 0; });
  EXPECT_GT(seen.torn, 0U);
}

TEST(LatestValue, GivesEachValueOnce) {
  LatestValue<int> value;
  int got = -1;
  EXPECT_FALSE(value.load(got));
  EXPECT_EQ(got, -1);
  value.store(1);
  value.store(2);
  EXPECT_TRUE(value.load(got));
  EXPECT_EQ(got, 2);
  EXPECT_FALSE(value.load(got));
  value.store(3);
  EXPECT_TRUE(value.load(got));
  EXPECT_EQ(got, 3);
}

}  // namespace
}  // namespace palpate::client
