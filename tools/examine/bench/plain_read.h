// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate::bench {

/// Reads every byte once, at the speed of the processor's vectors, and only adds: no work on these bytes can
/// be faster. @return their sum in words of eight bytes, so that the compiler keeps every read
[[nodiscard]] std::uint64_t plainRead(std::span<const std::byte> bytes) noexcept;

}  // namespace palpate::bench
