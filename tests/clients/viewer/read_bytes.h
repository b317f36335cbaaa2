// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpate::testing {

/// A number at an offset of a little-endian message, as PROTOCOL.md places it. @throw std::out_of_range
template <class T>
[[nodiscard]] T at(const std::vector<std::uint8_t>& bytes, std::size_t offset) {
  if (offset + sizeof(T) > bytes.size())
    throw std::out_of_range("message of " + std::to_string(bytes.size()) + " bytes ends before " +
                            std::to_string(offset + sizeof(T)));
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

/// Where the tools of a FRAME start.
[[nodiscard]] inline std::size_t toolsOffset(const std::vector<std::uint8_t>& frame) {
  const std::size_t field = 6 * static_cast<std::size_t>(at<std::uint32_t>(frame, 12));
  return 56 + (field + 3) / 4 * 4;
}

}  // namespace palpate::testing
