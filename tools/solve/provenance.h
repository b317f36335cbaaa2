// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/modelfile/mixed_precision.h"
#include "palpate/modelfile/model_data.h"
#include "palpate/offline/build_model.h"
#include "palpate/offline/case_file.h"

namespace palpate::solve {

/// Fills in provenance: program, time, case, mesh
/// with its SHA-256, timings, error of the fit after each sweep or what the pairs leave, load, how the modes are kept.
void addProvenance(modelfile::ModelData& data, const offline::Case& c, const offline::BuildReport& report,
                   const modelfile::StorageReport& storage);

}  // namespace palpate::solve
