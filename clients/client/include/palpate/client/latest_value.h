// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace palpate::client {

/// The newest value, handed from one writing thread to one reading thread without a lock: three slots, of
/// which the writer owns one, the reader one, and the third is exchanged. Real-time: yes, both ends.
template <class T>
class LatestValue {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// Writer's end.
  void store(const T& value) noexcept {
    slots_[write_] = value;
    // SYNC A: releases the value; pairs with the acquire in load(). Acquires the slot that load() gave back
    // (SYNC B).
    write_ = middle_.exchange(write_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  /// Reader's end. @return whether the value is one that no load() gave before; `value` is left alone when
  /// not
  [[nodiscard]] bool load(T& value) noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    // SYNC B: releases the slot read last; pairs with store(). Acquires the value that store() released (SYNC
    // A).
    read_ = middle_.exchange(read_, std::memory_order_acq_rel) & kIndex;
    value = slots_[read_];
    return true;
  }

 private:
  static constexpr std::uint32_t kIndex = 3;
  static constexpr std::uint32_t kFresh = 4;

  std::array<T, 3> slots_{};
  std::uint32_t write_{0};  // writer's only
  alignas(64) std::atomic<std::uint32_t> middle_{1};
  alignas(64) std::uint32_t read_{2};  // reader's only
};

}  // namespace palpate::client
