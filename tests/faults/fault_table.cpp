// SPDX-License-Identifier: Apache-2.0
#include "fault_table.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

namespace palpate::faults {
namespace {

using nlohmann::json;

constexpr char kRow[] = "FAULT  %-46s %-10s %-9s %9s %9s\n";

std::string text(const std::optional<double>& ms, const char* none) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.1f", ms.value_or(0.0));
  return ms ? buffer : none;
}

json jsonOf(const std::optional<double>& ms) {
  return ms ? json(*ms) : json();
}

}  // namespace

void tell(const Outcome& outcome) {
  static json rows = json::array();
  if (rows.empty()) std::printf(kRow, "fault", "zero / ms", "force", "again/ms", "lost / ms");
  char range[32];
  std::snprintf(range, sizeof range, "%.2f-%.2f", outcome.smallest, outcome.largest);
  std::printf(kRow, outcome.fault.c_str(), text(outcome.zero_ms, "goes on").c_str(), range,
              text(outcome.again_ms, "never").c_str(), text(outcome.recording_lacks_ms, "").c_str());
  std::fflush(stdout);
  rows.push_back({{"fault", outcome.fault},
                  {"zero_ms", jsonOf(outcome.zero_ms)},
                  {"smallest_share", outcome.smallest},
                  {"largest_share", outcome.largest},
                  {"again_ms", jsonOf(outcome.again_ms)},
                  {"recording_lacks_ms", jsonOf(outcome.recording_lacks_ms)}});
  if (const char* const file = std::getenv("PALPATE_FAULTS_JSON"))
    std::ofstream(file) << json{{"faults", rows}}.dump(2) << '\n';
}

}  // namespace palpate::faults
