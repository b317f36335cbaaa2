// SPDX-License-Identifier: Apache-2.0
#include "palpate/report/late_ticks.h"

#include <algorithm>
#include <array>

#include "palpate/report/program.h"

namespace palpate::report {
namespace {

using Count = std::uint64_t;

struct Cause {
  Count dds::LateTicks::*count;
  const char* word;
  const char* key;
};

constexpr std::array<Cause, 7> kCauses{{{&dds::LateTicks::unknown, "unknown", "unknown"},
                                        {&dds::LateTicks::own_work, "own work", "own_work"},
                                        {&dds::LateTicks::page_fault, "page fault", "page_fault"},
                                        {&dds::LateTicks::preempted, "preempted", "preempted"},
                                        {&dds::LateTicks::stopped, "stopped", "stopped"},
                                        {&dds::LateTicks::host_steal, "host steal", "host_steal"},
                                        {&dds::LateTicks::clock_step, "clock step", "clock_step"}}};

}  // namespace

dds::LateTicks lateSince(const dds::LateTicks& before, const dds::LateTicks& now) {
  dds::LateTicks late = now;
  for (const Cause& cause : kCauses) late.*cause.count -= std::min(before.*cause.count, now.*cause.count);
  if (late.preempted == 0) dds::assignText(late.preempted_by, "");
  return late;
}

std::uint64_t countOf(const dds::LateTicks& late) {
  Count count = 0;
  for (const Cause& cause : kCauses) count += late.*cause.count;
  return count;
}

std::string lateText(const dds::LateTicks& late) {
  if (countOf(late) == 0) return "none";
  std::array<Cause, 7> causes = kCauses;
  std::stable_sort(causes.begin(), causes.end(),
                   [&](const Cause& a, const Cause& b) { return late.*a.count > late.*b.count; });
  std::string text = std::to_string(countOf(late)) + ":";
  for (const Cause& cause : causes) {
    if (late.*cause.count == 0) continue;
    text.append(" ").append(std::to_string(late.*cause.count)).append(" ").append(cause.word);
    if (cause.count == &dds::LateTicks::preempted && late.preempted_by[0] != '\0')
      text.append(" by ").append(late.preempted_by);
    text += ";";
  }
  text.pop_back();
  return text;
}

program::Json toJson(const dds::LateTicks& late) {
  program::Json object = program::Json::object();
  for (const Cause& cause : kCauses) object[cause.key] = late.*cause.count;
  object["preempted_by"] = late.preempted_by;
  return object;
}

client::TimeSummary summaryOf(const dds::Percentiles& times) {
  return {times.p50, times.p99, times.p999, times.max, times.count};
}

program::Json timesJson(const dds::Percentiles& run, const dds::RecentTimes& recent) {
  return {{"run", toJson(summaryOf(run))},
          {"minute", toJson(summaryOf(recent.minute))},
          {"second", toJson(summaryOf(recent.second))}};
}

}  // namespace palpate::report
