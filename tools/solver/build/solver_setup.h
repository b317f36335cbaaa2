// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tools/mesh/tet_mesh.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/case_file.h"
#include "tools/solver/fem/patch.h"

namespace palpate::solver {

/// The contact positions of an organ: the accessible nodes, then the helpers beside them: nodes that share a
/// triangle with an accessible one, so that touches at the rim also interpolate between patches.
struct ContactPositions {
  std::vector<std::int32_t> nodes;       ///< M surface nodes
  std::vector<std::uint8_t> accessible;  ///< M, 0 for helpers
  std::vector<Patch> patches;            ///< M
};

/// @param accessible  by surface node
/// @throw CaseError naming an accessible node whose patch is all clamped, or of a radius whose patches have too many nodes
[[nodiscard]] ContactPositions contactPositions(const FeModel& model, const PatchSurface& surface,
                                                const std::vector<bool>& accessible, double patch_radius,
                                                const mesh::TetMesh& mesh);

/// Radius of the contact patch where the case does not give it, m. @param median_edge  of the surface, corner to corner, m
[[nodiscard]] double usualPatchRadius(double median_edge, bool quadratic);

/// The organ for every method: body, surface, patches.                       docs/design.md, Symbols
struct SolverSetup {
  FeModel model;
  PatchSurface surface;
  double patch_radius;  ///< a, m
  ContactPositions positions;

  /// @param mesh  checked  @throw CaseError naming the group, node or key that does not fit
  SolverSetup(const Case& c, const mesh::TetMesh& mesh);

  /// A_i of each contact position: quadrature weights over the load positions, M, m^2.
  [[nodiscard]] std::vector<double> positionAreas() const;
};

/// Fills in the surface, the contact positions and the volume mesh of a model file.
void storeOrgan(const SolverSetup& setup, const mesh::TetMesh& mesh, modelfile::ModelData& data);

}  // namespace palpate::solver
