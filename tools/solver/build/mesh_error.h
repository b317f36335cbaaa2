// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "core/base/contact_point.h"
#include "tools/mesh/tet_mesh.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/cholesky.h"

namespace palpate::solver {

/// By how much the mesh makes the organ too stiff at a point: n . K_s n of linear elasticity over the same of better elements,
/// less 1. Of linear elements, which lock everywhere, better is the whole organ with quadratic ones, up to 8000 nodes. Else
/// the elements within 5 patch widths are divided into eight; at the cut the finer part follows the coarse solution
/// (docs/decisions/mesh_error.md). Borrows all arguments. Several threads may ask at once.
class MeshErrors {
 public:
  /// @param factor  of K_T(0)
  MeshErrors(const SolverSetup& setup, const mesh::TetMesh& mesh, const Cholesky& factor);
  ~MeshErrors();
  MeshErrors(const MeshErrors&) = delete;
  MeshErrors& operator=(const MeshErrors&) = delete;
  /// Whether the whole organ with quadratic elements is what the mesh is compared with.
  [[nodiscard]] bool raised() const noexcept;
  /// @return nothing where springs are in reach, which the finer part has not. About a second.
  [[nodiscard]] std::optional<double> at(const ContactPoint& s) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// At up to 12 points of the accessible surface, drawn evenly by area, always the same ones.
[[nodiscard]] MeshError meshError(const SolverSetup& setup, const mesh::TetMesh& mesh, const Cholesky& factor,
                                  int workers);

}  // namespace palpate::solver
