// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "palpate/client/time_summary.h"
#include "palpate/idl/types.h"
#include "tools/program/json.h"

namespace palpate::report {

/// Ticks that were late between two statuses of one run of a server.
[[nodiscard]] dds::LateTicks lateSince(const dds::LateTicks& before, const dds::LateTicks& now);

[[nodiscard]] std::uint64_t countOf(const dds::LateTicks& late);

/// "none", or "5: 3 preempted by hog (77), FIFO 90; 2 unknown": the most frequent first.
[[nodiscard]] std::string lateText(const dds::LateTicks& late);

/// {unknown, own_work, page_fault, preempted, stopped, host_steal, clock_step, preempted_by}
[[nodiscard]] program::Json toJson(const dds::LateTicks& late);

[[nodiscard]] client::TimeSummary summaryOf(const dds::Percentiles& times);

/// {run, minute, second}: percentiles of a server's run, of its newest minute and of its newest second.
[[nodiscard]] program::Json timesJson(const dds::Percentiles& run, const dds::RecentTimes& recent);

}  // namespace palpate::report
