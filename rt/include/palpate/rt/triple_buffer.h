// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

#include "palpate/rt/cache_line.h"

namespace palpate::rt {

/// Latest value from one writer to one reader; neither ever waits for the other.
///
/// Three slots: the writer fills `back`, the reader looks at `front`, and the third lies in the middle. Each
/// side swaps its own slot with the middle one, so the two never share a slot. A new value replaces one that the
/// reader has not taken; publish() reports it.
///
/// T is any copyable type. A large one (a struct with sized vectors) is filled in place through back(): all
/// three slots are copies of the prototype, and nothing is allocated afterwards unless T's own use does.
/// Threads: exactly one writer (back, publish, write) and one reader (update, front, read). Real-time: yes.
template <class T>
class TripleBuffer {
 public:
  /// Allocates if copying T does: before the loop only. The reader finds the prototype until the first
  /// publish().
  explicit TripleBuffer(const T& prototype = T{})
      : slots_{Slot{prototype}, Slot{prototype}, Slot{prototype}} {}

  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  /// Writer: the slot to fill. It holds an old value, not the last one.
  [[nodiscard]] T& back() noexcept PALPATE_NONBLOCKING { return slots_[back_].value; }

  /// Writer: hands back() over.
  /// @return true when a value that the reader never took was replaced
  bool publish() noexcept PALPATE_NONBLOCKING {
    // SYNC A (release): pairs with SYNC B, so that the reader sees the slot as filled.
    // SYNC C (acquire): pairs with SYNC D, so that we refill a slot only after the reader's last look at it.
    const std::uint8_t old =
        middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel);
    back_ = old & kIndex;
    return (old & kFresh) != 0;
  }

  /// Writer: back() = value, then publish().
  bool write(const T& value) noexcept PALPATE_NONBLOCKING {
    static_assert(std::is_trivially_copyable_v<T>, "fill a large slot in place through back()");
    back() = value;
    return publish();
  }

  /// Reader: moves front() on to the latest value.
  /// @return false when nothing was published since the last call; front() then keeps its value
  [[nodiscard]] bool update() noexcept PALPATE_NONBLOCKING {
    // Relaxed: only a hint. The exchange below does the ordering.
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    // SYNC B (acquire): pairs with SYNC A in publish().
    // SYNC D (release): pairs with SYNC C in publish().
    const std::uint8_t old = middle_.exchange(front_, std::memory_order_acq_rel);
    front_ = old & kIndex;
    return true;
  }

  /// Reader: the value of the last update().
  [[nodiscard]] const T& front() const noexcept PALPATE_NONBLOCKING { return slots_[front_].value; }

  /// Reader: update(), then a copy of front().
  bool read(T& value) noexcept PALPATE_NONBLOCKING {
    static_assert(std::is_trivially_copyable_v<T>, "look at a large slot in place through front()");
    const bool fresh = update();
    value = front();
    return fresh;
  }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;

  struct alignas(kCacheLine) Slot {
    T value;
  };

  std::array<Slot, 3> slots_;
  alignas(kCacheLine) std::uint8_t back_{0};                 // writer's
  alignas(kCacheLine) std::atomic<std::uint8_t> middle_{1};  // shared
  alignas(kCacheLine) std::uint8_t front_{2};                // reader's

  static_assert(std::atomic<std::uint8_t>::is_always_lock_free);
};

}  // namespace palpate::rt
