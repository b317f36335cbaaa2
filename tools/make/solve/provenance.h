// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/modelfile/mixed_precision.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solve_program {

/// Fills in provenance: program, time, case, mesh
/// with its SHA-256, timings, error of the fit after each sweep or what the pairs leave, load, how the modes are kept.
void addProvenance(modelfile::ModelData& data, const solver::Case& c, const solver::BuildReport& report,
                   const modelfile::StorageReport& storage);

}  // namespace palpate::solve_program
