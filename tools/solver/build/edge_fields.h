// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/surface/contact_patches.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/cholesky.h"

namespace palpate::solver {

/// What the fields between positions are for.
struct EdgeNeed {
  double travel;       ///< m
  double error;        ///< asked of the field, of abs(d)
  double force_error;  ///< asked of the force, relative
};

/// How many edges there are, before any is solved.
struct EdgeCounts {
  std::size_t all{0}, solved{0};  ///< between contact positions; of these longer than the patch is wide
  int degree{0};                  ///< of what is solved
  double coefficients{0};         ///< Ce
  double nodes{0};                ///< near an edge, mean
};
[[nodiscard]] EdgeCounts edgeCounts(const SolverSetup& setup, int order);

/// /edges of a model: what the fields of a patch in the middle of an edge have beyond the model's own mixture there, degrees 2
/// and more, near the edge. The hierarchical surplus of H.-J. Bungartz, M. Griebel, Sparse grids, Acta Numerica 13 (2004),
/// 147-269. Edges that are short beside the patch add nothing.                                docs/design.md, Parts
/// Nothing is stored where the second largest of what 16 edges, spread over all long ones, add at the travel is at most a quarter
/// of the asked error. What mixing misses bounds d_max: of the ends of each edge, or of all positions where no edges are stored.
/// @param order  p, of the model's fields  @param[in,out] data  with surface, contact positions, modes and near field
/// @throw std::runtime_error when a series is not finite
[[nodiscard]] EdgeChoice storeEdgeFields(const SolverSetup& setup, const Cholesky& factor,
                                         const ContactPatches& patches, int order, const EdgeNeed& need,
                                         const BuildOptions& options, modelfile::ModelData& data);

}  // namespace palpate::solver
