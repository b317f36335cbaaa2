// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace palpate::organ {

/// What to tell about a body longer than 1 m or shorter than 5 mm: its length and the unit that would make it an
/// organ. Empty for other lengths.
/// @param length  m, the longest side of the bounding box
/// @param scale   metres per unit of the file, which gave this length
[[nodiscard]] std::optional<std::string> oddLength(double length, double scale);

}  // namespace palpate::organ
