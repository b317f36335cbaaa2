// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace palpate::client {

/// What to look at when nobody answers, behind a line that says so.
inline constexpr const char* kNoServerHint =
    "; is palpate-server running there, and does CYCLONEDDS_URI name the same network?";

/// " on DDS domain 7 within 0.30 s".
[[nodiscard]] inline std::string where(std::uint32_t domain, std::chrono::milliseconds waited) {
  return " on DDS domain " + std::to_string(domain) + " within " +
         std::to_string(static_cast<double>(waited.count()) * 1e-3).substr(0, 4) + " s";
}

}  // namespace palpate::client
