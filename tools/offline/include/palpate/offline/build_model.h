// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "palpate/mesh/tet_mesh.h"
#include "palpate/modelfile/model_data.h"
#include "palpate/offline/case_file.h"
#include "palpate/offline/patch.h"

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

/// The contact positions of an organ: the accessible nodes, then the helpers beside them: nodes that share a
/// triangle with an accessible one, so that the rim is interpolated between patches like everywhere else.
struct ContactPositions {
  std::vector<std::int32_t> nodes;       ///< M surface nodes
  std::vector<std::uint8_t> accessible;  ///< M, 0 for helpers
  std::vector<Patch> patches;            ///< M
};

/// @param accessible  by surface node  @throw CaseError naming an accessible node whose patch is all clamped
[[nodiscard]] ContactPositions contactPositions(const FeModel& model, const ContactSurface& surface,
                                                const std::vector<bool>& accessible, double patch_radius,
                                                const mesh::TetMesh& mesh);

/// The production track of DESIGN 2.2 and 2.3: series over all contact positions on all cores, far field,
/// near field. Memory is bounded by model and workers; the table of all fields goes through a scratch file.
/// @param mesh  checked  @throw CaseError, std::runtime_error
[[nodiscard]] modelfile::ModelData buildModel(const Case& c, const mesh::TetMesh& mesh,
                                              const BuildOptions& options, BuildReport& report);

}  // namespace palpate::offline
