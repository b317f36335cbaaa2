// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/model/meta_model.h"
#include "tools/examine/query/answer.h"
#include "tools/examine/query/touch_table.h"

namespace palpate::query {

/// What a touch of --batch is answered by.
struct BatchAnswer {
  TouchRow asked;
  Anchor anchor;
  Vec3 d = Vec3::Zero();  ///< as asked for, m
  Answer answer;          ///< without the field

  /// Whether the displacement that was used is shorter than what was asked for.
  [[nodiscard]] bool clamped() const;
};

/// The model's answers, in the order of the touches.
/// @throw program::ValueError naming file, line and columns of a place off the organ, or of a displacement that is none
[[nodiscard]] std::vector<BatchAnswer> answersTo(const MetaModel& model, std::span<const TouchRow> touches);

/// Comma-separated text: a line of columns, then one for each touch. Places and displacements that were asked for are repeated in
/// the unit they came in; each number is the shortest text that reads back as the same number.
[[nodiscard]] std::string batchText(std::span<const BatchAnswer> answers);

/// The columns of that text, for --help.
[[nodiscard]] std::string batchColumns();

}  // namespace palpate::query
