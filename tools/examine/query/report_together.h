// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/model/meta_model.h"
#include "tools/examine/query/full_solution.h"
#include "tools/examine/query/together.h"
#include "tools/program/json.h"

namespace palpate::query {

/// All that came out about tools that press together; borrowed.
struct JointFindings {
  const MetaModel& model;
  std::span<const Touch> touches;
  const JointAnswer& answer;
  const Organ* organ;         ///< with truth, else null
  const FullSolution* alone;  ///< Newton with the first tool alone, or null
  const FullSolution* truth;  ///< Newton with all tools, or null
};

/// The object `two_tools` of --json; keys in docs/json.md.
[[nodiscard]] program::Json toJson(const JointFindings& found);

/// The same for a person to read, several lines.
[[nodiscard]] std::string toText(const JointFindings& found);

}  // namespace palpate::query
