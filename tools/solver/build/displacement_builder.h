// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/multi_index.h"
#include "core/surface/contact_patches.h"
#include "tools/mesh/tet_mesh.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_model_parts.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"
#include "tools/solver/build/estimate.h"
#include "tools/solver/build/size_budget.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/cholesky.h"
#include "tools/solver/fit/far_field.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {

/// The organ, factorized at rest, and a case that names its orders.
struct ChosenOrgan {
  ChosenOrgan(const Case& c, const mesh::TetMesh& organ, const BuildOptions& options, BuildReport& report);

  mesh::TetMesh mesh;
  SolverSetup setup;
  Cholesky factor;
  Case chosen;
};

/// The work of buildDisplacementSeries() once the orders are known: series, Green's functions and edges
/// (displacement_series.cpp), the fit (displacement_fit.cpp), what a small file leaves out (handheld_fields.cpp), what all of it
/// takes (displacement_estimate.cpp). Borrows the organ.
class DisplacementBuilder {
 public:
  DisplacementBuilder(const ChosenOrgan& organ, const BuildOptions& options, BuildReport& report);
  modelfile::ModelData run();
  /// What run() takes, of time without what choosing the organ's orders took.
  [[nodiscard]] Estimate estimate() const;
  /// What of it can be said without a probe: bytes.
  [[nodiscard]] Estimate sizes() const;

 private:
  [[nodiscard]] SeriesSink seriesSink();
  void solveGreens(FieldTable& greens);
  void fit(const FieldTable& table, const FieldTable& greens);
  [[nodiscard]] double probeSeries(const SeriesOrders& orders, bool radii) const;
  [[nodiscard]] double probeGreens() const;
  [[nodiscard]] FitOptions fitOptions() const;
  void checkNear() const;
  bool widenNear();
  void storeFields(const FitProblem& problem, const FarField& far, const FieldTable& greens);
  void storeCompactFields(const FitProblem& problem, const FarField& far);
  [[nodiscard]] std::unique_ptr<FieldTable> shareLoads(const FieldTable& greens);
  [[nodiscard]] std::vector<std::int32_t> sourcesOfLoads() const;
  void makeCompact();
  [[nodiscard]] std::vector<float> greenSizes() const;
  [[nodiscard]] std::vector<NearNodes> nearOf(std::span<const std::int32_t> nodes) const;
  [[nodiscard]] std::vector<FitSource> fitSources(std::span<const std::int32_t> nodes,
                                                  std::span<const double> travel) const;
  [[nodiscard]] double scale(int k) const {
    return std::pow(d_ref_, force_basis_[k][0] + force_basis_[k][1] + force_basis_[k][2]);
  }

  const Case& case_;
  const mesh::TetMesh& mesh_;
  BuildOptions options_;
  BuildReport& report_;
  MonomialBasis basis_;        ///< of the fields
  MonomialBasis force_basis_;  ///< of the force; begins with the monomials of the fields
  const SolverSetup& setup_;
  const Cholesky& factor_;
  double d_ref_;        ///< half a patch width: the travel at which the fit weighs the orders
  double near_radius_;  ///< rho, m
  ContactPatches patches_;
  std::vector<std::int32_t> loaded_;    ///< surface nodes that patches load
  std::vector<NearNodes> near_;         ///< of each contact position
  std::vector<NearNodes> near_loaded_;  ///< of each loaded node
  std::optional<SizeBudget> budget_;    ///< of a handheld model
  modelfile::ModelData data_;
};

}  // namespace palpate::solver
