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

// The wrong twin: shows the counter before the value is in the slot, and frees the slot before it was copied
// out. Relaxed atomics throughout, so that ThreadSanitizer leaves it to the check.
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

// Counts values that are not the next ones in order, whole. Ends after kValues, or at the first wrong one, or
// in time.
template <class Queue>
std::uint64_t wrongValues(Queue& queue, std::int64_t end_ns) {
  std::atomic<bool> stop{false};
  std::thread producer([&] {
    std::uint64_t number = 0;
    while (!stop.load(std::memory_order_relaxed)) {
      if (queue.push(filled(number + 1))) ++number;
    }
  });
  std::uint64_t wrong = 0;
  std::uint64_t expected = 0;
  Value value{};
  while (expected < kValues && wrong == 0 && monotonicNow() < end_ns) {
    if (queue.pop(value)) wrong += value == filled(++expected) ? 0 : 1;
  }
  stop = true;
  producer.join();
  return wrong;
}

TEST(SpscQueueStress, EveryValueArrivesWholeAndInOrder) {
  SpscQueue<Value, 8> queue;
  EXPECT_EQ(wrongValues(queue, monotonicNow() + 20'000'000'000), 0U);
}

TEST(SpscQueueStress, TheCheckCatchesAQueueThatCountsBeforeItCopies) {
  std::uint64_t wrong = 0;
  const std::int64_t end = monotonicNow() + 30'000'000'000;
  while (wrong == 0 && monotonicNow() < end) {
    HastyQueue queue;
    wrong = wrongValues(queue, end);
  }
  EXPECT_GT(wrong, 0U) << "the test above could not fail either";
}

}  // namespace
}  // namespace palpate::rt
