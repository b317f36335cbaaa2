// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "palpate/rt/cycle_stats.h"
#include "palpate/server/records.h"

namespace palpate::server {

/// State and statistics of the server. Only the events thread reads and writes it.
struct Health {
  TickRecord last;        ///< newest record, with the totals
  rt::CycleStats tick;    ///< compute time of ticks
  rt::CycleStats wakeup;  ///< how late they woke
  std::uint64_t unknown_tools{0};
  std::uint64_t misaddressed_poses{0};
  std::uint64_t failed_writes{0};
  std::uint64_t surplus_requests{0};  ///< parameter requests dropped because too many came
  std::size_t rivals{0};
  std::int64_t rival_since_ns{0};  ///< our monotonic clock
  std::int64_t now_ns{0};          ///< when the events were last looked at
  std::string rival;               ///< one of them
  std::uint32_t recent_flags{0};   ///< of all tools since the last status, or-ed
  std::string message;             ///< newest event
  AllToolSettings settings{};      ///< in force
  std::uint64_t parameters_revision{0};
};

}  // namespace palpate::server
