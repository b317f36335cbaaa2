// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "palpate/client/time_summary.h"
#include "tools/program/json.h"

namespace palpate::report {

/// Names of the bits of ToolForce::flags, joined by " "; "-" for none.
[[nodiscard]] std::string flagNames(std::uint32_t flags);

/// {p50, p99, p999, max, count}, us.
[[nodiscard]] program::Json toJson(const client::TimeSummary& summary);

}  // namespace palpate::report
