// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/prefetch.h"

namespace palpate {

/// Whole numbers of one or of two bytes each, where a model file has them. Borrows. Real-time: yes.
class WholeNumbers {
 public:
  WholeNumbers() noexcept = default;
  WholeNumbers(std::span<const std::int8_t> numbers) noexcept
      : int8_(numbers.data()), count_(numbers.size()) {}
  WholeNumbers(std::span<const std::int16_t> numbers) noexcept
      : int16_(numbers.data()), count_(numbers.size()) {}

  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] std::size_t size_bytes() const noexcept { return count_ * bytesOfOne(); }
  /// All of them as they lie in memory.
  [[nodiscard]] std::span<const std::byte> asBytes() const noexcept {
    return {static_cast<const std::byte*>(first()), size_bytes()};
  }
  [[nodiscard]] int operator[](std::size_t i) const noexcept PALPATE_NONBLOCKING {
    return int8_ != nullptr ? int{int8_[i]} : int{int16_[i]};
  }
  /// Those from number `first` on.
  [[nodiscard]] WholeNumbers from(std::size_t first) const noexcept PALPATE_NONBLOCKING {
    WholeNumbers rest = *this;
    if (int8_ != nullptr)
      rest.int8_ += first;
    else
      rest.int16_ += first;
    rest.count_ -= first;
    return rest;
  }
  /// Asks the cache for the first numbers.
  void expect(std::size_t numbers) const noexcept PALPATE_NONBLOCKING {
    prefetch(first(), numbers * bytesOfOne());
  }
  /// The first where each has one byte; else null.
  [[nodiscard]] const std::int8_t* int8() const noexcept PALPATE_NONBLOCKING { return int8_; }
  /// The first where each has two bytes; else null.
  [[nodiscard]] const std::int16_t* int16() const noexcept PALPATE_NONBLOCKING { return int16_; }

 private:
  [[nodiscard]] std::size_t bytesOfOne() const noexcept { return int8_ != nullptr ? 1 : 2; }
  [[nodiscard]] const void* first() const noexcept {
    return int8_ != nullptr ? static_cast<const void*>(int8_) : int16_;
  }

  const std::int8_t* int8_{nullptr};
  const std::int16_t* int16_{nullptr};  // null where int8_ is not
  std::size_t count_{0};
};

}  // namespace palpate
