// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/examine/certify/examination.h"

namespace palpate::certify {

/// Errors of force and field over abs(d), a point for each touch that was solved, those beyond the domain hollow, as one
/// self-contained SVG that reads on light and on dark ground. @param title  above it
[[nodiscard]] std::string errorPlot(const std::string& title, const std::vector<Finding>& findings);

}  // namespace palpate::certify
