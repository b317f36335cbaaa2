// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::program {

/// The one of `known` that somebody who wrote `word` meant: it begins with `word`, or becomes it by few edits, at most one
/// for each three letters and two at most. An edit is a letter more, less or another one, or two neighbours swapped
/// (optimal string alignment). Dashes at the begin do not count. Nothing when none is as near, or `word` is shorter than two letters.
[[nodiscard]] std::optional<std::string> nearestWord(std::string_view word,
                                                     const std::vector<std::string>& known);

}  // namespace palpate::program
