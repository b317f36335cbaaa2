// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate::server {

// Kinds of warning, in addition to one per tool and flag (tool << 32 | flag). Each is told once a second.
constexpr std::uint64_t kOverrunKind = 1ULL << 63;
constexpr std::uint64_t kDropKind = kOverrunKind + 1;
constexpr std::uint64_t kUnknownToolKind = kOverrunKind + 2;
constexpr std::uint64_t kFailedWriteKind = kOverrunKind + 3;
constexpr std::uint64_t kChangedKind = kOverrunKind + 4;
constexpr std::uint64_t kRecordingFailedKind = kOverrunKind + 5;
constexpr std::uint64_t kUnrecordedKind = kOverrunKind + 6;
constexpr std::uint64_t kRefusedKind = kOverrunKind + 7;
constexpr std::uint64_t kPhaseKind = kOverrunKind + 8;
constexpr std::uint64_t kMisaddressedKind = kOverrunKind + 9;
constexpr std::uint64_t kRequestFloodKind = kOverrunKind + 10;
constexpr std::uint64_t kRivalKind = kOverrunKind + 11;
constexpr std::uint64_t kMisfitKind = kOverrunKind + 12;
constexpr std::uint64_t kAnnouncedKind = kOverrunKind + 13;
constexpr std::uint64_t kAnnouncementFloodKind = kOverrunKind + 14;
constexpr std::uint64_t kLateKind = kOverrunKind + 15;
constexpr std::uint64_t kClockStepKind = kOverrunKind + 16;
constexpr std::uint64_t kOutsiderKind = kOverrunKind + 17;
constexpr std::uint64_t kDdsLineKind = kOverrunKind + 18;

}  // namespace palpate::server
