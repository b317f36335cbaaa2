// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "palpate/mesh/tet_mesh.h"
#include "palpate/offline/case_file.h"
#include "palpate/offline/solver_setup.h"

namespace palpate::offline {

struct BuildOptions {
  int workers{1};
  std::filesystem::path scratch{"."};  ///< folder of the scratch file
  bool quiet{false};
};

/// Where the time went and how well the modes fit.
struct BuildReport {
  double factor_seconds{0}, series_seconds{0}, fit_seconds{0};
  std::vector<double> fit_errors;  ///< after each sweep, see FarField::errors
};

/// The production track of DESIGN 2.2 and 2.3: series over all contact positions on all cores, far field,
/// near field. Memory is bounded by model and workers; the table of all fields goes through a scratch file.
/// @param mesh  checked  @throw CaseError, std::runtime_error
[[nodiscard]] modelfile::ModelData buildModel(const Case& c, const mesh::TetMesh& mesh,
                                              const BuildOptions& options, BuildReport& report);

}  // namespace palpate::offline
