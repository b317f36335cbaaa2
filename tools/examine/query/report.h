// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/model/meta_model.h"
#include "tools/examine/query/answer.h"
#include "tools/examine/query/full_solution.h"
#include "tools/program/json.h"

namespace palpate::query {

/// All that came out of one query; borrowed.
struct Findings {
  const MetaModel& model;
  const Anchor& anchor;
  const Question& question;  ///< as asked for
  const Answer& answer;
  const Organ* organ;         ///< with truth, else null
  const FullSolution* truth;  ///< null: not asked for
};

/// The object of --json; keys in docs/json.md.
[[nodiscard]] program::Json toJson(const Findings& found);

/// The same for a person to read, several lines.
[[nodiscard]] std::string toText(const Findings& found);

}  // namespace palpate::query
