// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/examine/fit/findings.h"

namespace palpate::fit {

/// Measured points over the fitted curve, those beyond the domain hollow, and their residuals below, over depth, as one
/// self-contained SVG that reads on light and on dark ground. @param title  above it
[[nodiscard]] std::string fitPlot(const std::string& title, const Findings& found);

}  // namespace palpate::fit
