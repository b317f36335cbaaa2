// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/examine/reproduce/output.h"
#include "tools/program/json.h"

namespace palpate::reproduce {

struct RodOptions {
  int elements{40};                                         ///< linear elements, >= 1
  std::vector<int> steps{10, 20, 50, 100, 200, 500, 1000};  ///< load steps; the last is the finest
  int workers{1};
};

/// Section 4.1 and Figure 1. Writes its figures and tables to `out`. @return the contents of results.json
[[nodiscard]] Json reproduceRod(const RodOptions& options, Output& out);

}  // namespace palpate::reproduce
