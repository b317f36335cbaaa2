// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tools/examine/certify/certificate.h"
#include "tools/examine/certify/report/report_folder.h"

namespace palpate::certify {

/// What was examined. Borrowed.
struct Examined {
  std::string file;  ///< of the model, as it was named
  const MetaModel& model;
  const query::Organ& organ;
  const Drawing& drawing;
  const Examination& found;
  const program::Json& certificate;  ///< certificateOf(), and its pairs where there are any
};

/// Solves two force curves, draws, and writes report.html and report.json.
/// @param status  one line: certified, or why not  @param youngs_modulus_error  relative, of the band on the curves
/// @throw program::WriteError, query::QueryError, std::runtime_error
void writeReport(const ReportFolder& folder, const Examined& examined, const std::string& status,
                 std::optional<double> youngs_modulus_error, int threads);

}  // namespace palpate::certify
