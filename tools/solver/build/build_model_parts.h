// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <functional>
#include <span>
#include <vector>

#include "core/data/model_view.h"
#include "tools/mesh/tet_mesh.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/cholesky.h"
#include "tools/solver/fit/field_table.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {

// Parts that the methods share.

/// Wall-clock time since its construction, s.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
};

/// Factorizes K_T(0). @throw std::runtime_error naming the node where it is not positive definite
void factorizeAtRest(Cholesky& factor, const SolverSetup& setup, const mesh::TetMesh& mesh, const Case& c);

/// What the case asks of force and field within d_max.
[[nodiscard]] DomainCriteria criteriaOf(const Case& c);

/// What a model keeps of the series of a position beside its fields: some numbers, as many for each.
struct SeriesSink {
  std::size_t count;  ///< of the numbers
  /// Called from several threads, once for each position that is solved.
  std::function<std::vector<double>(const SeriesSolver& series, int lane, const SeriesRadii& radii)> numbers;
  /// Called once for each position of all ranks.
  std::function<void(std::size_t position, std::span<const double> numbers)> store;
};

/// Places on the surface in blocks, neighbours together.
/// @param nodes  surface nodes  @param part  how many are solved at once
[[nodiscard]] Blocks blocksOf(const SolverSetup& setup, std::span<const std::int32_t> nodes, std::size_t part,
                              const Ranks& ranks);

/// Solves the series of all contact positions on all workers of all ranks; surface fields go to the table.
/// @param table  positions x coefficients of the fields x 3 Ns, in blocks of parts of kLanes, kept where options.checkpoint keeps
///               their journal
/// @throw std::runtime_error naming the node whose series has no domain
void solveAllSeries(const SolverSetup& setup, const mesh::TetMesh& mesh, const Case& c,
                    const Cholesky& factor, SeriesKind kind, const BuildOptions& options, FieldTable& table,
                    const SeriesSink& sink);

/// Attributes that every kind of model has.
void storeAttributes(const Case& c, const SolverSetup& setup, ModelAttributes& attributes);

}  // namespace palpate::solver
