// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "palpate/rt/clock.h"
#include "palpate/rt/triple_buffer.h"

namespace palpate::rt {
namespace {

constexpr std::size_t kWords = 256;
constexpr std::int64_t kSecond = 1'000'000'000;

// All words are equal, so that a mixture of two values shows.
using Value = std::array<std::uint64_t, kWords>;

Value filled(std::uint64_t number) {
  Value value;
  value.fill(number);
  return value;
}

bool isTorn(const Value& value) {
  for (const std::uint64_t word : value) {
    if (word != value[0]) return true;
  }
  return false;
}

// The same interface without the protocol: one slot that both sides touch. The words are relaxed atomics, so
// that this is no data race in the language, and ThreadSanitizer leaves it to the check.
class TornBuffer {
 public:
  void write(const Value& value) {
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(value[i], std::memory_order_relaxed);
  }
  bool read(Value& value) {
    for (std::size_t i = 0; i < kWords; ++i) value[i] = words_[i].load(std::memory_order_relaxed);
    return true;
  }

 private:
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

struct Outcome {
  std::uint64_t reads{0};
  std::uint64_t torn{0};
  std::uint64_t backwards{0};
  std::uint64_t last{0};
};

// Reads until `enough` says so. The writer counts up until it is told to stop, and then writes one last
// value.
template <class Buffer, class Enough>
Outcome race(Buffer& buffer, std::uint64_t& last_written, Enough enough) {
  std::atomic<bool> stop{false};
  std::thread writer([&] {
    std::uint64_t number = 0;
    while (!stop.load(std::memory_order_relaxed)) buffer.write(filled(++number));
    last_written = number;
  });
  Outcome outcome;
  Value value{};
  while (!enough(outcome)) {
    if (!buffer.read(value)) continue;
    ++outcome.reads;
    outcome.torn += isTorn(value) ? 1 : 0;
    outcome.backwards += value[0] < outcome.last ? 1 : 0;
    outcome.last = value[0];
  }
  stop = true;
  writer.join();
  if (buffer.read(value)) outcome.last = value[0];
  return outcome;
}

TEST(TripleBufferStress, ReaderNeverSeesATornValue) {
  TripleBuffer<Value> buffer;
  const std::int64_t end = monotonicNow() + kSecond / 2;
  std::uint64_t last_written = 0;
  const Outcome outcome =
      race(buffer, last_written, [&](const Outcome& o) { return o.reads >= 1000 && monotonicNow() > end; });
  EXPECT_EQ(outcome.torn, 0U);
  EXPECT_EQ(outcome.backwards, 0U);
  EXPECT_EQ(outcome.last, last_written) << "the last value was lost";
}

TEST(TripleBufferStress, TheCheckCatchesABufferWithoutTheProtocol) {
  TornBuffer buffer;
  const std::int64_t end = monotonicNow() + 30 * kSecond;
  std::uint64_t last_written = 0;
  const Outcome outcome =
      race(buffer, last_written, [&](const Outcome& o) { return o.torn > 0 || monotonicNow() > end; });
  EXPECT_GT(outcome.torn, 0U) << "after " << outcome.reads << " reads: the test above could not fail either";
}

TEST(TripleBufferStress, EveryValueIsEitherReadOrReportedAsReplaced) {
  TripleBuffer<std::uint64_t> buffer;
  constexpr std::uint64_t kValues = 200'000;
  std::uint64_t replaced = 0;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kValues; ++i) replaced += buffer.write(i) ? 1 : 0;
    done = true;
  });
  std::uint64_t taken = 0;
  std::uint64_t value = 0;
  while (!done) taken += buffer.read(value) ? 1 : 0;
  writer.join();
  taken += buffer.read(value) ? 1 : 0;
  EXPECT_EQ(taken + replaced, kValues);
  EXPECT_EQ(value, kValues);
}

}  // namespace
}  // namespace palpate::rt
