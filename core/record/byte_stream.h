// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "core/record/recording.h"

namespace palpate::record {

static_assert(std::endian::native == std::endian::little,
              "a recording is little-endian, and written as it lies");

using Bytes = std::vector<std::uint8_t>;

/// Appends bytes as they lie.
void putBytes(Bytes& out, const void* from, std::size_t size);

/// Appends numbers, or arrays of numbers, as they lie.
template <class T>
void put(Bytes& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  putBytes(out, &value, sizeof(T));
}

/// Takes from the front of a block. @throw RecordError when the block is too short
class ByteSource {
 public:
  explicit ByteSource(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  template <class T>
  void get(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (rest_.size() < sizeof(T)) throw RecordError("a record ends early");
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_ = rest_.subspan(sizeof(T));
  }
  template <class T>
  [[nodiscard]] T get() {
    T value{};
    get(value);
    return value;
  }
  [[nodiscard]] std::span<const std::uint8_t> take(std::size_t size) {
    if (rest_.size() < size) throw RecordError("a record ends early");
    const auto front = rest_.first(size);
    rest_ = rest_.subspan(size);
    return front;
  }
  [[nodiscard]] bool empty() const noexcept { return rest_.empty(); }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace palpate::record
