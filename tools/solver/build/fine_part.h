// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "tools/mesh/tet_mesh.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/patch.h"

namespace palpate::solver {

/// Nodal vectors, 3 N x 3: one for each direction of a load.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

[[nodiscard]] std::array<Vec3, 3> cornersOf(const PatchSurface& surface, std::size_t face);
[[nodiscard]] PatchSurface surfaceOf(const FeModel& model, const mesh::TetMesh& mesh);
/// The point of a face that is nearest to x in its plane.
[[nodiscard]] ContactPoint pointAt(const PatchSurface& surface, const Vec3& x);
/// G_s: unit loads on a patch, unknowns x 3.
[[nodiscard]] Eigen::MatrixXd loads(const FeModel& model, const Patch& patch);
/// Unknowns to nodes.
[[nodiscard]] Columns nodal(const FeModel& model, const Eigen::MatrixXd& unknowns);
/// n . K_s n, N/m. @param u  the fields of unit loads
[[nodiscard]] double stiffnessOf(const Patch& patch, const Columns& u, const Vec3& n);

/// The elements with a corner nearer to x than that, m.
[[nodiscard]] std::vector<std::int32_t> elementsNear(const mesh::TetMesh& mesh, const Vec3& x, double reach);

/// Some elements, such as those near a point, divided into eight, with the coarse solution where they were cut out.
class FinePart {
 public:
  FinePart(const SolverSetup& setup, const mesh::TetMesh& mesh, const Columns& coarse,
           std::span<const std::int32_t> chosen);
  /// n . K_s n of the patch at x.
  [[nodiscard]] double stiffnessAt(const Vec3& x, const Vec3& n, double patch_radius) const;

 private:
  void follow(const SolverSetup& setup, const mesh::TetMesh& mesh, const Columns& coarse,
              const std::set<std::array<std::int32_t, 3>>& cut);

  mesh::TetMesh mesh_;
  std::vector<std::int32_t> parent_;
  std::vector<std::int32_t> held_;  // at the cut, and where the organ is clamped
  Columns given_;                   // 3 N x 3, m: the coarse solution at held nodes
  Material material_;
};

}  // namespace palpate::solver
