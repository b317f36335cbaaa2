// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/surface/contact_patches.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fit/field_table.h"

namespace palpate::solver {

/// Loads of a third as many sources as loaded nodes: of quadratic elements patches load the middles of edges, and these share
/// what they carry between the ends (core's LinearField). Each end is then the source of a load R_c of its own,
///   w_i(s) ~ sum_c R_ic q_c(s),   q_c(s) = sum of w_j(s) / 2 over the edges j that end at c,
/// by least squares over contact positions, edge midpoints and the middles of faces.   docs/decisions/handheld.md
struct SharedLoads {
  std::vector<std::int32_t> nodes;  ///< surface nodes, ascending
  Eigen::MatrixXf R;                ///< loaded nodes x nodes, each column sums to about 1
  double error;  ///< largest sum over i of abs(w_i(s) - sum_c R_ic q_c(s)) / 2, of all these s
};

/// Their nodes: the ends of the edges whose middles are loaded, ascending. @return empty where a loaded node is none, as of
/// linear elements
[[nodiscard]] std::vector<std::int32_t> sharedSources(const PatchSurface& surface,
                                                      std::span<const std::int32_t> loaded);

/// @param loaded  surface nodes that patches load, ascending: middles of edges of the faces
/// @return empty where a loaded node is none, as of linear elements
[[nodiscard]] SharedLoads sharedLoads(const SolverSetup& setup, const ContactPatches& patches,
                                      std::span<const std::int32_t> loaded, int workers, bool quiet = true);

inline constexpr std::size_t kSummedAtOnce = std::size_t{1} << 30U;

/// The fields of these loads: sum_i W_i R_ic.
/// @param greens  W_i of the loaded nodes, three columns each  @param[out] fields  the same of the sources
/// @param bytes  of fields that are summed at once, of 64 sources at least: all greens are read for so many
void superpose(const FieldTable& greens, const SharedLoads& loads, const BuildOptions& options,
               FieldTable& fields, std::size_t bytes = kSummedAtOnce);

}  // namespace palpate::solver
