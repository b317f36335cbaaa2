// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/examine/certify/report/content.h"

namespace palpate::certify {

/// A picture of the report.
struct Figure {
  std::string svg;
  std::string alternative;  ///< for readers who cannot see it
  std::string caption;
};

/// The pictures of each part of the report. Surfaces are seen from two sides, along their thinnest extent.
struct Figures {
  std::vector<Figure> stiffness, force_error, field_error, errors_by_length, curves, reach;
};

[[nodiscard]] Figures figuresOf(const ReportInput& input);

}  // namespace palpate::certify
