// SPDX-License-Identifier: Apache-2.0
#include "late_log.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "late_injections.h"

namespace palpate::proof {
namespace {

template <class Function>
void forEachLine(const std::string& log, std::string_view begin, Function function) {
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t at = line.find(begin); at != std::string::npos) function(line.substr(at));
}

// For how long an injection and a late tick are at the same time, us; not above 0: never.
std::int64_t overlap(const Injection& injection, const ToldTick& tick) {
  return std::min(injection.at_us + injection.for_us, tick.due_us + tick.late_us) -
         std::max(injection.at_us, tick.due_us);
}

}  // namespace

std::vector<ToldTick> toldTicks(const std::string& log) {
  std::vector<ToldTick> told;
  forEachLine(log, "a tick due at ", [&told](const std::string& line) {
    long long due = 0, late = 0;
    int rest = 0;
    if (std::sscanf(line.c_str(), "a tick due at %lld us ended %lld us later: %n", &due, &late, &rest) == 2)
      told.push_back({due, late, line.substr(static_cast<std::size_t>(rest))});
  });
  return told;
}

std::vector<Injection> injections(const std::string& log) {
  std::vector<Injection> injected;
  forEachLine(log, "injected at ", [&injected](const std::string& line) {
    long long at = 0, spent = 0;
    if (std::sscanf(line.c_str(), kInjectedLine, &at, &spent) == 2) injected.push_back({at, spent});
  });
  return injected;
}

Named compare(const std::vector<Injection>& injected, const std::vector<ToldTick>& told,
              std::string_view cause) {
  Named named;
  for (const Injection& injection : injected) {
    const auto tick =
        std::max_element(told.begin(), told.end(), [&injection](const ToldTick& a, const ToldTick& b) {
          return overlap(injection, a) < overlap(injection, b);
        });
    const bool found = tick != told.end() && overlap(injection, *tick) > 0;
    if (found && tick->late_us > 2 * injection.for_us) continue;  // late by something else for the most part
    ++named.clear;
    if (found && tick->cause.starts_with(cause)) {
      ++named.right;
      continue;
    }
    named.wrongly +=
        "at " + std::to_string(injection.at_us) + " us for " + std::to_string(injection.for_us) +
        " us: " + (found ? std::to_string(tick->late_us) + " us late, " + tick->cause : "no late tick") +
        '\n';
  }
  return named;
}

}  // namespace palpate::proof
