// SPDX-License-Identifier: Apache-2.0
#include "palpate/report/program.h"

#include <array>
#include <utility>

#include "palpate/idl/types.h"

namespace palpate::report {

std::string flagNames(std::uint32_t flags) {
  std::string names;
  for (const auto& [bit, name] : dds::flag::kWords)
    if ((flags & bit) != 0) {
      if (!names.empty()) names += ' ';
      names += name;
    }
  return names.empty() ? "-" : names;
}

program::Json toJson(const client::TimeSummary& summary) {
  return {{"p50", summary.p50},
          {"p99", summary.p99},
          {"p999", summary.p999},
          {"max", summary.max},
          {"count", summary.count}};
}

}  // namespace palpate::report
