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

/// Where the time went and how well the modes fit. What a method does not have stays 0, or empty.
struct BuildReport {
  double factor_seconds{0}, series_seconds{0}, fit_seconds{0};
  double pgd_seconds{0}, recompression_seconds{0};
  std::vector<double> fit_errors;  ///< series methods: after each sweep, see FarField::errors
  int greedy_pairs{0};             ///< PGD methods: pairs before recompression
  double residual{0};              ///< PGD methods: of the last enrichment, dual norm, relative, an estimate
  double truncation{0};            ///< PGD methods: energy norm of what recompression left out, relative
  double load_truncation{0};       ///< pgd-linear: of the load in m terms, Eq. (2), relative, in nodal forces
  double load{0};                  ///< PGD methods: N
  int weak_positions{0};           ///< load-driven: positions where the modes are too few to invert dd/df
};

/// The model of an organ by c.method: a table of methods is in tools/solve/README.md.
/// The series methods bound memory by model and workers; the table of all fields goes through a scratch file.
/// @param mesh  checked  @throw CaseError, std::runtime_error
[[nodiscard]] modelfile::ModelData buildModel(const Case& c, const mesh::TetMesh& mesh,
                                              const BuildOptions& options, BuildReport& report);

}  // namespace palpate::offline
