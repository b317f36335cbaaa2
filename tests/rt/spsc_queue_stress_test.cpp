// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "palpate/rt/clock.h"
#include "palpate/rt/spsc_queue.h"

namespace palpate::rt {
namespace {

constexpr std::size_t kWords = 32;
constexpr std::uint64_t kValues = 300'000;
using Value = std::array<std::uint64_t, kWords>;

Value filled(std::uint64_t number) {
  Value value;
  value.fill(number);
  return value;
}

// The wrong twin: publishes the counter before the value is in the slot, and frees the slot before its value is
// copied out. Relaxed atomics throughout, so that ThreadSanitizer leaves it to the check.
class HastyQueue {
 public:
  bool push(const Value& value) {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_.load(std::memory_order_relaxed) == kSlots) return false;
    tail_.store(tail + 1, std::memory_order_relaxed);
    for (std::size_t i = 0; i < kWords; ++i)
      slots_[tail % kSlots][i].store(value[i], std::memory_order_relaxed);
    return true;
  }
  bool pop(Value& value) {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_relaxed)) return false;
    head_.store(head + 1, std::memory_order_relaxed);
    for (std::size_t i = 0; i < kWords; ++i)
      value[i] = slots_[head % kSlots][i].load(std::memory_order_relaxed);
    return true;
  }

 private:
  static constexpr std::size_t kSlots = 8;
  std::array<std::array<std::atomic<std::uint64_t>, kWords>, kSlots> slots_{};
  std::atomic<std::uint64_t> tail_{0};
  std::atomic<std::uint64_t> head_{0};
};

// The other wrong twin: passes a few values and then none, as if one side never saw the other's counter.
class StallingQueue {
 public:
  bool push(const Value& value) { return pushed_ < kLast && queue_.push(value) && ++pushed_ > 0; }
  bool pop(Value& value) { return queue_.pop(value); }

 private:
  static constexpr std::uint64_t kLast = 100;
  SpscQueue<Value, 8> queue_;
  std::uint64_t pushed_{0};  // the producer's own
};

struct Tally {
  std::uint64_t wrong{0};     // values that are not the next ones in order, whole
  std::uint64_t received{0};  // all values
};

// Ends after kValues, or at the first wrong one, or in time.
template <class Queue>
Tally tally(Queue& queue, std::int64_t end_ns) {
  std::atomic<bool> stop{false};
  std::thread producer([&] {
    std::uint64_t number = 0;
    while (!stop.load(std::memory_order_relaxed)) {
      if (queue.push(filled(number + 1))) ++number;
    }
  });
  Tally seen;
  Value value{};
  while (seen.received < kValues && seen.wrong == 0 && monotonicNow() < end_ns) {
    if (queue.pop(value)) seen.wrong += value == filled(++seen.received) ? 0 : 1;
  }
  stop = true;
  producer.join();
  return seen;
}

TEST(SpscQueueStress, EveryValueArrivesWholeAndInOrder) {
  SpscQueue<Value, 8> queue;
  const Tally seen = tally(queue, monotonicNow() + 60'000'000'000);
  EXPECT_EQ(seen.wrong, 0U);
  EXPECT_EQ(seen.received, kValues);
}

TEST(SpscQueueStress, TheCheckCatchesAQueueThatCountsBeforeItCopies) {
  std::uint64_t wrong = 0;
  const std::int64_t end = monotonicNow() + 30'000'000'000;
  while (wrong == 0 && monotonicNow() < end) {
    HastyQueue queue;
    wrong = tally(queue, end).wrong;
  }
  EXPECT_GT(wrong, 0U) << "the test above could not fail either";
}

TEST(SpscQueueStress, TheCheckCatchesAQueueThatStalls) {
  StallingQueue queue;
  const Tally seen = tally(queue, monotonicNow() + 500'000'000);
  EXPECT_EQ(seen.wrong, 0U);
  EXPECT_LT(seen.received, kValues) << "the count of the test above could not fail either";
}

}  // namespace
}  // namespace palpate::rt
