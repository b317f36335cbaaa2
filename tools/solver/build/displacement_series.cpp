// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/displacement_series.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/multi_index.h"
#include "core/data/model_view.h"
#include "core/surface/contact_patches.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/build/build_model_parts.h"
#include "tools/solver/build/displacement_fields.h"
#include "tools/solver/build/domain_rings.h"
#include "tools/solver/build/edge_fields.h"
#include "tools/solver/build/linear_answers.h"
#include "tools/solver/build/mesh_error.h"
#include "tools/solver/build/travel_orders.h"
#include "tools/solver/fit/far_field.h"
#include "tools/solver/series/nodal_greens.h"

namespace palpate::solver {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

constexpr int kFewModes = 100;  ///< to begin with, where their number is not given

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", x);
  return buffer;
}

/// Collects the parts of the model.
class Builder {
 public:
  Builder(const Case& c, const mesh::TetMesh& mesh, const SolverSetup& setup, const Cholesky& factor,
          const BuildOptions& options, BuildReport& report);
  modelfile::ModelData run();

 private:
  void storePosition(const SeriesSolver& series, int lane, std::size_t position, const SeriesRadii& radii);
  void solveGreens(FieldTable& greens);
  void fit(const FieldTable& table, const FieldTable& greens);
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
  modelfile::ModelData data_;
};

double nearBytes(std::span<const NearNodes> near, int coefficients) {
  double bytes = 0.0;
  for (const NearNodes& nodes : near) bytes += 12.0 * coefficients * static_cast<double>(nodes.nodes.size());
  return bytes;
}

/// The near field is part of the model; this program and the server hold all of it in memory.
void checkNearBytes(double near_radius, double bytes) {
  constexpr double kMost = 2147483648.0;
  if (bytes > kMost)
    throw CaseError("model.near_radius = " + text(near_radius) + " m makes a near field of " +
                    text(1e-6 * bytes) + " MB; the limit is " + text(1e-6 * kMost) + " MB");
}

std::vector<NearNodes> Builder::nearOf(std::span<const std::int32_t> nodes) const {
  std::vector<NearNodes> near;
  for (const std::int32_t node : nodes)
    near.push_back(nearNodes(setup_.surface, setup_.surface.positions[at(node)], near_radius_));
  return near;
}

Builder::Builder(const Case& c, const mesh::TetMesh& mesh, const SolverSetup& setup, const Cholesky& factor,
                 const BuildOptions& options, BuildReport& report)
    : case_(c),
      mesh_(mesh),
      options_(options),
      report_(report),
      basis_(c.orders().fields),
      force_basis_(c.orders().answer),
      setup_(setup),
      factor_(factor),
      d_ref_(0.5 * setup_.patch_radius),
      near_radius_(c.nearRadiusOrDefault(setup_.patch_radius)),
      patches_(setup_.surface.graph, freeNodes(setup_.model, setup_.surface), setup_.patch_radius,
               setup_.positions.nodes),
      loaded_(loadedNodes(setup_, patches_)),
      near_(nearOf(setup_.positions.nodes)),
      near_loaded_(nearOf(loaded_)) {
  report_.median_edge = setup_.surface.medianEdge();
  checkNearBytes(near_radius_, nearBytes(near_, basis_.size()) + nearBytes(near_loaded_, 3));
  const std::size_t coefficients = static_cast<std::size_t>(force_basis_.size());
  data_.contact_force.resize(setup_.positions.nodes.size() * coefficients * 3);
  data_.contact_domain_radius.resize(setup_.positions.nodes.size());
  data_.contact_series_radius.resize(setup_.positions.nodes.size());
}

void Builder::storePosition(const SeriesSolver& series, int lane, std::size_t position,
                            const SeriesRadii& radii) {
  data_.contact_domain_radius[position] = radii.domain;
  data_.contact_series_radius[position] = radii.series;
  const std::size_t coefficients = at(force_basis_.size());
  for (int k = 0; k < force_basis_.size(); ++k) {
    const Vec3 f = series.answer(lane, k) * scale(k);
    for (int c = 0; c < 3; ++c) data_.contact_force[(position * coefficients + at(k)) * 3 + at(c)] = f[c];
  }
}

/// The fields of unit loads at single nodes.
void Builder::solveGreens(FieldTable& greens) {
  constexpr double kWidest = 6.5;  // of a patch's nodes, in a
  CloseGreens close(setup_.surface, loaded_, kWidest * setup_.patch_radius);
  Progress progress("nodal Green's functions", loaded_.size(), options_.quiet);
  std::vector<std::unique_ptr<NodalGreens>> solvers(at(options_.workers));
  const std::size_t chunk = NodalGreens::kMost;
  parallelFor(options_.workers, (loaded_.size() + chunk - 1) / chunk, [&](int worker, std::size_t number) {
    auto& solver = solvers[at(worker)];
    if (!solver) solver = std::make_unique<NodalGreens>(setup_.model, factor_, setup_.surface);
    const std::size_t first = number * chunk, count = std::min(chunk, loaded_.size() - first);
    solver->solve(std::span(loaded_).subspan(first, count));
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::MatrixXd& W = solver->of(i);
      close.keep(first + i, W);
      const Eigen::MatrixXf per_load = W.cast<float>();
      greens.write(first + i, {per_load.data(), static_cast<std::size_t>(per_load.size())});
    }
    progress.advance(count);
  });
  data_.contact_stiffness = patchStiffness(setup_, patches_, close, options_.workers);
}

/// @param travel  m, of each; empty: d_ref
std::vector<FitSource> Builder::fitSources(std::span<const std::int32_t> nodes,
                                           std::span<const double> travel) const {
  std::vector<FitSource> sources;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec3& place = setup_.surface.positions[at(nodes[i])];
    // Large travel is rare and must not cost accuracy at small travel.
    const double ball = travel.empty() ? d_ref_ : std::min(d_ref_, travel[i]);
    sources.push_back({place, fitWeights(setup_.surface, place, near_radius_), ball, d_ref_});
  }
  return sources;
}

/// The modes are those of the patches' fields, which are smoother than those of single nodes: they want fewer.
void Builder::fit(const FieldTable& table, const FieldTable& greens) {
  const std::vector<FitSource> sources = fitSources(setup_.positions.nodes, data_.contact_domain_radius);
  const FitProblem problem{table, basis_, setup_.surface.areas, setup_.surface.positions, sources, d_ref_};
  FitOptions options;
  report_.fit_asked = case_.modes ? 0.0 : case_.fieldErrorOrDefault();
  options.error = report_.fit_asked;
  options.modes = case_.modes.value_or(kFewModes);
  options.head_start = 3;
  options.sweeps = case_.sweepsOrDefault();
  options.reweighted = std::min(2, options.sweeps);
  options.workers = options_.workers;
  options.quiet = options_.quiet;
  const FarField far = fitFarField(problem, options);
  report_.fit_errors = far.errors;
  std::vector<float> largest = far.largest;
  std::sort(largest.begin(), largest.end());
  report_.fit_p95 = largest[largest.size() - 1 - largest.size() / 20];
  report_.fit_max = largest.back();
  data_.modes_X.assign(far.X.data(), far.X.data() + far.X.size());
  const std::vector<FitSource> loaded = fitSources(loaded_, {});
  const MonomialBasis linear(1);
  const FitProblem by_load{greens, linear, setup_.surface.areas, setup_.surface.positions, loaded, d_ref_};
  data_.green_node = loaded_;
  storeGreens(by_load, far.X, near_loaded_, options_.workers, data_);
  storeNearField(problem, far, near_, options_.workers, data_);
}

modelfile::ModelData Builder::run() {
  const Stopwatch series_watch;
  const std::size_t rows = 3 * setup_.surface.nodes.size();
  FieldTable table(options_.scratch, setup_.positions.nodes.size(), at(basis_.size()), rows);
  solveAllSeries(setup_, mesh_, case_, factor_, SeriesKind::kDisplacement, options_, table,
                 [&](const SeriesSolver& series, int lane, std::size_t position, const SeriesRadii& radii) {
                   storePosition(series, lane, position, radii);
                 });
  FieldTable greens(options_.scratch, loaded_.size(), 3, rows);
  solveGreens(greens);
  report_.series_seconds = series_watch.seconds();

  const Stopwatch fit_watch;
  fit(table, greens);  // by each position's own radius
  report_.fit_seconds = fit_watch.seconds();
  data_.contact_domain_radius =
      leastWithinTwoRings(setup_.surface.faces, setup_.positions.nodes, data_.contact_domain_radius);

  storeOrgan(setup_, mesh_, data_);
  ModelAttributes& a = data_.attributes;
  storeAttributes(case_, setup_, a);
  a.order = basis_.order();
  a.force_order = force_basis_.order();
  a.near_radius = near_radius_;
  a.reference_displacement = d_ref_;
  const Stopwatch edge_watch;
  storeEdgeFields(setup_, factor_, patches_, basis_.order(), options_, data_);
  report_.series_seconds += edge_watch.seconds();
  return std::move(data_);
}

}  // namespace

modelfile::ModelData buildDisplacementSeries(const Case& c, const mesh::TetMesh& mesh,
                                             const BuildOptions& options, BuildReport& report) {
  const SolverSetup setup(c, mesh);
  const Stopwatch factor_watch;
  Cholesky factor(setup.model);
  factorizeAtRest(factor, setup, mesh, c);
  report.factor_seconds = factor_watch.seconds();
  if (c.mesh_error) {
    const Stopwatch mesh_watch;
    report.mesh_error = meshError(setup, mesh, factor, options.workers);
    report.mesh_error_seconds = mesh_watch.seconds();
  }
  Case chosen = c;
  if (c.travel) {
    const Stopwatch orders_watch;
    report.travel = ordersFor(*c.travel, setup, factor, options);
    chosen.order = report.travel->orders.fields;
    chosen.force_order = report.travel->orders.answer;
    report.orders_seconds = orders_watch.seconds();
  }
  return Builder(chosen, mesh, setup, factor, options, report).run();
}

}  // namespace palpate::solver
