// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "palpate/rt/cache_line.h"

namespace palpate::rt {

/// Every value in order from one producer to one consumer; a full ring refuses the new value, it never waits.
/// Each side keeps a copy of the other's counter and reads the shared one only when the copy says full or
/// empty.
/// @tparam N  capacity, a power of two
/// Threads: exactly one producer (push) and one consumer (pop). Real-time: yes, no allocation after
/// construction.
template <class T, std::size_t N>
class SpscQueue {
  static_assert(N >= 2 && (N & (N - 1)) == 0, "the capacity is a power of two");
  static_assert(std::is_trivially_copyable_v<T>, "what crosses a thread is plain arrays");

 public:
  SpscQueue() = default;
  SpscQueue(const SpscQueue&) = delete;
  SpscQueue& operator=(const SpscQueue&) = delete;

  /// Producer. @return false when the ring is full; the value is then not taken
  [[nodiscard]] bool push(const T& value) noexcept PALPATE_NONBLOCKING {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);  // our own counter
    if (tail - head_seen_ == N) {
      // SYNC A (acquire): pairs with SYNC B in pop(): the slot is free only after its value was copied out.
      head_seen_ = head_.load(std::memory_order_acquire);
      if (tail - head_seen_ == N) return false;
    }
    slots_[tail & (N - 1)] = value;
    // SYNC C (release): pairs with SYNC D in pop(): a consumer that sees the counter sees the value.
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  /// Consumer. @return false when the ring is empty; value is then untouched
  [[nodiscard]] bool pop(T& value) noexcept PALPATE_NONBLOCKING {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);  // our own counter
    if (head == tail_seen_) {
      // SYNC D (acquire): pairs with SYNC C in push().
      tail_seen_ = tail_.load(std::memory_order_acquire);
      if (head == tail_seen_) return false;
    }
    value = slots_[head & (N - 1)];
    // SYNC B (release): pairs with SYNC A in push().
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  [[nodiscard]] static constexpr std::size_t capacity() noexcept { return N; }

 private:
  std::array<T, N> slots_{};
  alignas(kCacheLine) std::atomic<std::uint64_t> tail_{0};  // producer's, values pushed so far
  std::uint64_t head_seen_{0};                              // producer's copy
  alignas(kCacheLine) std::atomic<std::uint64_t> head_{0};  // consumer's, values popped so far
  std::uint64_t tail_seen_{0};                              // consumer's copy

  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
};

}  // namespace palpate::rt
