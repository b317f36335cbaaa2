// SPDX-License-Identifier: Apache-2.0
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "counted_run.h"

namespace palpate::proof {
namespace {

void row(std::ostream& out, const std::string& what, std::int64_t counted, const std::string& allowed) {
  out << std::left << std::setw(44) << what << std::right << std::setw(10) << counted << "   " << allowed
      << '\n';
}

double percent(std::uint64_t part, std::uint64_t all) {
  return all == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

nlohmann::json toJson(const Answers& answers) {
  return {{"answers", answers.all},
          {"in_contact", answers.in_contact},
          {"sliding", answers.sliding},
          {"free", answers.free}};
}

}  // namespace

std::string table(const CountedRun& run) {
  std::ostringstream out;
  out << "the tick thread of palpate-server, " << run.seconds << " s, two tools, " << run.model << '\n'
      << "real-time priority: " << (run.realtime ? "yes" : "no")
      << "; memory locked: " << (run.memory_locked ? "yes" : "no") << "\n\n"
      << "in all ticks together                           counted   allowed\n";
  row(out, "ticks, each with one sleep", run.sleeps, "");
  row(out, "allocations", run.of(Kind::kAllocation), "0");
  row(out, "frees", run.of(Kind::kFree), "0");
  row(out, "mutexes and other locks taken", run.of(Kind::kLock), "0");
  row(out, "other waits", run.of(Kind::kWait), "0");
  row(out, "calls for files, sockets and mappings", run.of(Kind::kSystemCall), "0");
  row(out, "page faults", run.faults(), run.memory_locked ? "0" : "not judged: memory could not be locked");
  row(out, "voluntary context switches", run.usage.voluntary, "one a sleep");
  row(out, "involuntary context switches", run.usage.involuntary, "not judged: the machine's");
  for (const Posts& posts : run.posts)
    if (posts.semaphore != 0) row(out, "wake-ups of another thread", posts.count, "one a tick");
  for (std::size_t i = 0; i < run.tools.size(); ++i) {
    const Answers& tool = run.tools[i];
    out << "tool " << i << ": " << tool.all << " answers, " << std::fixed << std::setprecision(0)
        << percent(tool.in_contact, tool.all) << " % in contact, " << percent(tool.sliding, tool.all)
        << " % sliding\n";
  }
  return out.str();
}

std::string json(const CountedRun& run) {
  nlohmann::json posts = nlohmann::json::array();
  for (const Posts& each : run.posts)
    if (each.semaphore != 0) posts.push_back(each.count);
  const nlohmann::json out{
      {"model", run.model},
      {"seconds", run.seconds},
      {"realtime", run.realtime},
      {"memory_locked", run.memory_locked},
      {"ticks", run.sleeps},
      {"allocations", run.of(Kind::kAllocation)},
      {"frees", run.of(Kind::kFree)},
      {"locks", run.of(Kind::kLock)},
      {"waits", run.of(Kind::kWait)},
      {"system_calls", run.of(Kind::kSystemCall)},
      {"page_faults", {{"minor", run.usage.minor_faults}, {"major", run.usage.major_faults}}},
      {"context_switches", {{"voluntary", run.usage.voluntary}, {"involuntary", run.usage.involuntary}}},
      {"posts", posts},
      {"tools", {toJson(run.tools[0]), toJson(run.tools[1])}}};
  return out.dump(2) + '\n';
}

}  // namespace palpate::proof
