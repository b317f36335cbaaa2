// SPDX-License-Identifier: Apache-2.0
#include "tools/program/svg.h"

#include "tools/program/printed.h"
#include "tools/program/xml.h"

namespace palpate::program {

std::string svgStart(double width, double height, const std::string& style) {
  // The grounds of SvgPlot.
  constexpr const char* kStyle = R"(<style>
svg { background: #ffffff; color: #1f2328; }
text { font: 13px sans-serif; fill: currentColor; }
.title { font-size: 16px; font-weight: bold; }
.grid { stroke: currentColor; stroke-opacity: 0.2; }
@media (prefers-color-scheme: dark) { svg { background: #0d1117; color: #e6edf3; } }
)";
  return printed(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f "
             "%.0f\">\n",
             width, height, width, height) +
         kStyle + style + "</style>\n";
}

std::string svgText(double x, double y, const std::string& text, const char* extra) {
  return printed("<text x=\"%.1f\" y=\"%.1f\"%s>", x, y, extra) + xmlEscaped(text) + "</text>\n";
}

}  // namespace palpate::program
