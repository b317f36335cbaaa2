// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/examine/reproduce/beam_options.h"
#include "tools/mesh/tet_mesh.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/fem/patch.h"
#include "tools/solver/pgd/parametric_problem.h"

namespace palpate::reproduce {

/// The beam of Section 4.2: 400 x 40 x 40 mm, E = 1 MPa, nu = 0.25, clamped at x = 0; a single nodal force downward
/// at any free node of the upper surface.                                        docs/design.md, Reproduction
struct Beam {
  mesh::TetMesh mesh;
  solver::FeModel model;
  solver::PatchSurface surface;
  std::vector<std::int32_t> nodes;  ///< volume node of each position
  solver::BodyProblem problem;      ///< weights: the nodes' share of the upper surface, m^2
  int tip;                          ///< position nearest to the middle of the upper edge at the free end

  std::vector<std::int32_t> axis;  ///< volume nodes nearest to the axis, from the clamp to the free end

  explicit Beam(const BeamOptions& options);
  Beam(const Beam&) = delete;
  Beam& operator=(const Beam&) = delete;

  /// E A, N.
  [[nodiscard]] double axialStiffness() const;
  [[nodiscard]] Eigen::VectorXd toUnknowns(const Eigen::VectorXd& nodal) const;
};

}  // namespace palpate::reproduce
