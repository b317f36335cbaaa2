// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "palpate/rt/cycle_stats.h"
#include "palpate/rt/late_cause.h"
#include "palpate/rt/recent_stats.h"
#include "palpate/server/records.h"

namespace palpate::server {

/// A time over the run and over what was just now.
struct Times {
  rt::CycleStats run;
  rt::RecentStats recent;

  void add(std::int64_t ns) {
    run.add(ns);
    recent.add(ns);
  }
};

/// State and statistics of the server. Only the events thread reads and writes it.
struct Health {
  TickRecord last;  ///< newest record, with the totals
  Times tick;       ///< compute time of ticks
  Times wakeup;     ///< how late they woke
  Times receive;    ///< from a pose's sending to its hand-over, of senders on this host
  Times force_out;  ///< from a force's hand-over until DDS has it
  std::array<std::uint64_t, rt::kLateCauses> late{};  ///< late ticks by rt::LateCause
  std::string preempted_by;                           ///< the newest thread that had the tick's processor
  std::uint64_t clock_steps{0};                       ///< how often the wall clock was set
  std::int64_t clock_step_ns{0};                      ///< the last time
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
