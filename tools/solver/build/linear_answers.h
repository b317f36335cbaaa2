// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/surface/contact_patches.h"
#include "tools/solver/base/ranks.h"
#include "tools/solver/build/solver_setup.h"

namespace palpate::solver {

/// The surface's compliance between nodes that can be in one patch: displacement of node j by unit forces at node i, 3 x 3,
/// m/N.
class CloseGreens {
 public:
  /// @param sources  surface nodes i  @param reach  of the pairs, m, straight
  CloseGreens(const PatchSurface& surface, std::span<const std::int32_t> sources, double reach);
  /// Keeps what is close of a Green's function. Threads: any number, for different sources.
  /// @param which  number of the source  @param field  3 Ns x 3
  void keep(std::size_t which, const Eigen::Ref<const Eigen::MatrixXf>& field);
  /// What is kept of a source, for other ranks.
  [[nodiscard]] std::span<float> of(std::size_t which);
  /// Q_j = sum_i w_i W_ij for the patch's own nodes j, m/N.
  void apply(const PatchNodes& patch, std::vector<Eigen::Matrix3d>& Q) const;

 private:
  std::vector<std::size_t> first_;       // [sources + 1]
  std::vector<std::int32_t> node_;       // ascending for each source
  std::vector<Eigen::Matrix3f> block_;   // W_ij
  std::vector<std::int32_t> source_of_;  // [Ns] or -1
};

/// The surface nodes that patches in the triangles of contact positions may load, ascending.
[[nodiscard]] std::vector<std::int32_t> loadedNodes(const SolverSetup& setup, const ContactPatches& patches);

/// The stiffness of patches at rest, K_s = C_s^-1, C_s = sum w_i(s) w_j(s) W_ij, exact at the smooth places, with its
/// gradient over the surface, the mean of those in the triangles round the place.         docs/design.md, Parts
/// @return [places][6][4]: xx xy xz yy yz zz of K, N/m, each with its gradient, N/m^2
/// @throw std::runtime_error naming the node near which the compliance of a patch is not positive definite
[[nodiscard]] std::vector<double> patchStiffness(const SolverSetup& setup, const ContactPatches& patches,
                                                 const CloseGreens& greens, int workers,
                                                 const Ranks& ranks = Ranks::one());

}  // namespace palpate::solver
