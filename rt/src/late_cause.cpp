// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/late_cause.h"

#include <algorithm>

namespace palpate::rt {
namespace {

LateCause causeOfRunning(const LateFacts& facts) noexcept PALPATE_NONBLOCKING {
  const std::int64_t cost = facts.minor_faults * kFaultCost + facts.major_faults * kReadCost;
  return 2 * cost >= facts.cpu_ns && cost > 0 ? LateCause::kPageFault : LateCause::kOwnWork;
}

LateCause causeOfStanding(const LateFacts& facts) noexcept PALPATE_NONBLOCKING {
  if (facts.extra_waits > 0)
    return facts.minor_faults + facts.major_faults > 0 ? LateCause::kPageFault : LateCause::kStopped;
  return facts.stolen ? LateCause::kHostSteal : LateCause::kUnknown;
}

}  // namespace

const char* wordOf(LateCause cause) noexcept {
  constexpr std::array<const char*, kLateCauses> kWords{"unknown", "own work",   "page fault", "preempted",
                                                        "stopped", "host steal", "clock step"};
  const auto index = static_cast<std::size_t>(cause);
  return kWords[index < kLateCauses ? index : 0];
}

LateCause causeOf(const LateFacts& facts) noexcept PALPATE_NONBLOCKING {
  const std::int64_t standing = facts.span_ns - facts.leapt_ns - facts.queued_ns - facts.cpu_ns;
  const std::int64_t largest = std::max({facts.leapt_ns, facts.queued_ns, facts.cpu_ns, standing});
  if (largest <= 0) return LateCause::kUnknown;
  if (largest == facts.leapt_ns) return LateCause::kClockStep;
  if (largest == facts.queued_ns) return LateCause::kPreempted;
  return largest == facts.cpu_ns ? causeOfRunning(facts) : causeOfStanding(facts);
}

}  // namespace palpate::rt
