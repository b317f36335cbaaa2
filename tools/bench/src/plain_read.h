// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate::bench {

/// Reads every byte once, as fast as the processor's vectors do, and does next to nothing with it: the least
/// time in which anything that needs these bytes can be done. @return their sum in words of eight, so that no
/// read is left out
[[nodiscard]] std::uint64_t plainRead(std::span<const std::byte> bytes) noexcept;

}  // namespace palpate::bench
