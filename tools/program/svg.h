// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palpate::program {

/// The start of a self-contained SVG that reads on light and on dark ground. "</svg>" ends it.
/// @param[in] width, height  px  @param[in] style  rules beside those for text, .title and .grid
[[nodiscard]] std::string svgStart(double width, double height, const std::string& style);

/// A text at a point. @param[in] text  plain  @param[in] extra  attributes, with a space before each
[[nodiscard]] std::string svgText(double x, double y, const std::string& text, const char* extra = "");

}  // namespace palpate::program
