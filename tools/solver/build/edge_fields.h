// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/surface/contact_patches.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/cholesky.h"

namespace palpate::solver {

/// /edges of a model: what the fields of a patch in the middle of an edge have beyond the model's own mixture there, degrees 2
/// and more, near the edge. The hierarchical surplus of H.-J. Bungartz, M. Griebel, Sparse grids, Acta Numerica 13 (2004),
/// 147-269. Edges that are short beside the patch add nothing.                                docs/design.md, Parts
/// @param order  p, of the model's fields  @param data  with surface, contact positions, modes and near field
/// @throw std::runtime_error when a series is not finite
void storeEdgeFields(const SolverSetup& setup, const Cholesky& factor, const ContactPatches& patches,
                     int order, const BuildOptions& options, modelfile::ModelData& data);

}  // namespace palpate::solver
