// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/examine/certify/examination.h"
#include "tools/program/svg_plot.h"

namespace palpate::certify {

/// Errors of force and field over abs(d), a mark for each touch that was solved, those beyond the domain hollow, without a title.
[[nodiscard]] program::SvgPlot errorPlot(const std::vector<Finding>& findings);

}  // namespace palpate::certify
