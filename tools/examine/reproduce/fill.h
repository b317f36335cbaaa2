// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/examine/reproduce/output.h"
#include "tools/program/json.h"

namespace palpate::reproduce {

/// Fills results into a text: `{a_b_c:.3f}` stands for results["a"]["b"]["c"], array entries count from 0,
/// and `{pct_a_b_c:.1f}` is a hundred times that. Numbers format as double, strings as they are.
/// @throw ReproduceError naming a missing result
[[nodiscard]] std::string fill(std::string_view text, const Json& results);

/// @param figures  the folder that takes the place of each "@" behind "(": "(@a.png)" becomes "(figures/a.png)"
[[nodiscard]] std::string withFolder(std::string text, const std::string& figures);

/// A column of a Markdown table: its head, the key in each row, a format such as "{:.3g}", a factor.
struct Column {
  std::string head, key, format;
  double factor{1.0};
};

/// @param rows  array of objects; a missing or null number becomes "-"
[[nodiscard]] std::string table(const Json& rows, const std::vector<Column>& columns);

}  // namespace palpate::reproduce
