// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace palpate::faults {

/// What is in a recording, whether it ends or not.
struct Recorded {
  std::uint64_t ticks{0};
  std::uint64_t gaps{0};         ///< ticks that ran between two that are in it
  std::uint64_t missing{0};      ///< as its end says
  bool ended{false};             ///< it has an end
  std::int64_t last_woke_ns{0};  ///< CLOCK_MONOTONIC
};

/// @throw record::RecordError  damage; a file that is cut off is none
[[nodiscard]] Recorded read(const std::filesystem::path& path);

}  // namespace palpate::faults
