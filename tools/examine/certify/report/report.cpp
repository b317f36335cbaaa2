// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/report.h"

#include <utility>

#include "tools/examine/certify/report/content.h"
#include "tools/examine/certify/report/page.h"
#include "tools/examine/certify/report/page_view.h"
#include "tools/examine/certify/report/pictures.h"

namespace palpate::certify {

void writeReport(const ReportFolder& folder, const Examined& e, const std::string& status,
                 std::optional<double> youngs_modulus_error, int threads) {
  SurfaceMaps maps = surfaceMapsOf(e.model);
  std::vector<ForceCurve> curves =
      forceCurves(e.model, e.organ, e.found, maps, e.drawing.travel.length, threads);
  const ReportInput input{e.file,
                          e.model,
                          e.drawing,
                          e.found,
                          e.certificate,
                          status,
                          youngs_modulus_error,
                          std::move(maps),
                          std::move(curves),
                          checkedInPlace(e.organ)};
  const program::Json content = contentOf(input);
  folder.write(pageOf(pageViewOf(content, figuresOf(input))),
               content.dump(-1, program::Keys::kAsWritten) + '\n');
}

}  // namespace palpate::certify
