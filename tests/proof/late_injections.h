// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace palpate::proof {

/// What the library late_injector does to a server: the environment names it.
inline constexpr const char* kLateCauseVariable = "PALPATE_LATE_CAUSE";
inline constexpr std::string_view kWork = "work";    ///< the tick computes for 5 ms
inline constexpr std::string_view kFault = "fault";  ///< the tick touches 4000 fresh pages
/// the tick reads for 5 ms, from a file whose pages are not in memory
inline constexpr std::string_view kRead = "read";
inline constexpr const char* kLateFileVariable = "PALPATE_LATE_FILE";
inline constexpr std::string_view kLeap = "leap";  ///< CLOCK_MONOTONIC leaps ahead by 5 ms
/// CLOCK_REALTIME is set 2 s ahead, once; the tick computes for 5 ms
inline constexpr std::string_view kWall = "wall";

inline constexpr int kInjections = 60;

/// What it writes to standard error after each: when it began, by the server's CLOCK_MONOTONIC, and for how long, us.
inline constexpr const char* kInjectedLine = "injected at %lld us for %lld us\n";

}  // namespace palpate::proof
