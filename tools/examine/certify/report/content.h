// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/examine/certify/certificate.h"
#include "tools/examine/certify/report/checks_in_place.h"
#include "tools/examine/certify/report/force_curves.h"
#include "tools/examine/certify/report/surface_maps.h"

namespace palpate::certify {

/// What a report is made from. Borrows all but what was computed for it.
struct ReportInput {
  std::string file;  ///< of the model, as it was named
  const MetaModel& model;
  const Drawing& drawing;
  const Examination& found;
  const program::Json& certificate;            ///< certificateOf(), and its pairs where there are any
  std::string status;                          ///< one line: certified, or why not
  std::optional<double> youngs_modulus_error;  ///< relative
  SurfaceMaps maps;
  std::vector<ForceCurve> curves;
  ChecksInPlace checks;
};

/// All that the report says, in numbers: report.json. Keys in docs/json.md. @throw program::JsonError
[[nodiscard]] program::Json contentOf(const ReportInput& input);

}  // namespace palpate::certify
