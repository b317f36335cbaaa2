// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/displacement_series.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
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
#include "tools/solver/build/shared_loads.h"
#include "tools/solver/build/size_budget.h"
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
  [[nodiscard]] FitOptions fitOptions() const;
  void storeFields(const FitProblem& problem, const FarField& far, const FieldTable& greens);
  [[nodiscard]] std::unique_ptr<FieldTable> shareLoads(const FieldTable& greens);
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

FitOptions Builder::fitOptions() const {
  FitOptions options;
  options.error = report_.fit_asked;
  options.modes = case_.modes.value_or(budget_ ? budget_->modes() : kFewModes);
  options.head_start = 3;
  options.sweeps = case_.sweepsOrDefault();
  options.reweighted = std::min(2, options.sweeps);
  options.workers = options_.workers;
  options.quiet = options_.quiet;
  return options;
}

/// The modes are those of the patches' fields, which are smoother than those of single nodes: they want fewer.
void Builder::fit(const FieldTable& table, const FieldTable& greens) {
  const std::vector<FitSource> sources = fitSources(setup_.positions.nodes, data_.contact_domain_radius);
  const FitProblem problem{table, basis_, setup_.surface.areas, setup_.surface.positions, sources, d_ref_};
  report_.fit_asked = case_.modes || budget_ ? 0.0 : case_.fieldErrorOrDefault();
  const FarField far = fitFarField(problem, fitOptions());
  report_.fit_errors = far.errors;
  std::vector<float> largest = far.largest;
  std::sort(largest.begin(), largest.end());
  report_.fit_p95 = largest[largest.size() - 1 - largest.size() / 20];
  report_.fit_max = largest.back();
  data_.modes_X.assign(far.X.data(), far.X.data() + far.X.size());
  storeFields(problem, far, greens);
}

/// By node of the near fields of loads, how far the whole force of a patch there moves it over abs(d).
std::vector<float> Builder::greenSizes() const {
  std::vector<float> sizes;
  for (std::size_t g = 0; g < loaded_.size(); ++g) {
    const Vec3& place = setup_.surface.positions[at(loaded_[g])];
    const auto apart = [&](std::int32_t node) {
      return (setup_.surface.positions[at(node)] - place).squaredNorm();
    };
    const auto nearest =
        std::min_element(setup_.positions.nodes.begin(), setup_.positions.nodes.end(),
                         [&](std::int32_t l, std::int32_t r) { return apart(l) < apart(r); });
    const double* const K =
        data_.contact_stiffness.data() +
        kStiffnessNumbers * static_cast<std::size_t>(nearest - setup_.positions.nodes.begin());
    const double stiffest = Mat3{{K[0], K[4], K[8]}, {K[4], K[12], K[16]}, {K[8], K[16], K[20]}}.norm();
    const auto count = data_.green_offset[g + 1] - data_.green_offset[g];
    const float* const near = data_.green_near.data() + 9 * data_.green_offset[g];
    for (std::int64_t j = 0; j < count; ++j) {
      double square = 0.0;
      for (std::int64_t load = 0; load < 3; ++load)
        square = std::max(
            square, double{Eigen::Map<const Eigen::Vector3f>(near + 3 * (load * count + j)).squaredNorm()});
      sizes.push_back(static_cast<float>(stiffest * std::sqrt(square)));
    }
  }
  return sizes;
}

void Builder::storeFields(const FitProblem& problem, const FarField& far, const FieldTable& greens) {
  const std::vector<FitSource> loaded = fitSources(loaded_, {});
  const MonomialBasis linear(1);
  const FitProblem by_load{greens, linear, setup_.surface.areas, setup_.surface.positions, loaded, d_ref_};
  data_.green_node = loaded_;
  storeGreens(by_load, far.X, near_loaded_, options_.workers, data_);
  if (!budget_) {
    (void)storeNearField(problem, far, near_, options_.workers, data_);
    return;
  }
  std::vector<FitSource> pressed(problem.sources.begin(), problem.sources.end());
  for (std::size_t p = 0; p < pressed.size(); ++p)
    pressed[p].ball_radius = std::min(case_.travelOrDefault(), data_.contact_series_radius[p]);
  const FitProblem travelled{problem.table, problem.basis, problem.areas, problem.places, pressed, d_ref_};
  FarField bent;  // orders of two and more are smaller: fewer modes do
  bent.X = far.X.leftCols(SizeBudget::positionModes(far.X.cols()));
  bent.Y = amplitudesOf(problem, bent.X, options_.workers);
  data_.position_modes = static_cast<std::size_t>(bent.X.cols());
  NearSizes sizes;
  sizes.positions = storeNearField(travelled, bent, near_, options_.workers, data_);
  sizes.greens = greenSizes();
  report_.size = budget_->leaveOut(sizes, data_);
}

/// A third as many sources of the linear field, where elements are quadratic. @return their fields, or null
std::unique_ptr<FieldTable> Builder::shareLoads(const FieldTable& greens) {
  const SharedLoads shared = sharedLoads(setup_, patches_, loaded_);
  if (shared.nodes.empty()) return nullptr;
  auto fields =
      std::make_unique<FieldTable>(options_.scratch, shared.nodes.size(), std::size_t{3}, greens.rows());
  superpose(greens, shared, options_.workers, *fields);
  report_.shared_loads = shared.error;
  loaded_ = shared.nodes;
  near_loaded_ = nearOf(loaded_);
  return fields;
}

/// What a small file has in fewer digits: floats are enough for a force, a stiffness and a radius.
void Builder::makeCompact() {
  data_.compact = true;
  for (std::vector<double>* const numbers : {&data_.contact_force, &data_.contact_stiffness,
                                             &data_.contact_domain_radius, &data_.contact_series_radius})
    for (double& number : *numbers) number = double{static_cast<float>(number)};
  budget_.emplace(data_, loaded_.size(), case_.sizeLimitOrDefault());
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
  storeOrgan(setup_, mesh_, data_);
  ModelAttributes& a = data_.attributes;
  storeAttributes(case_, setup_, a);
  a.order = basis_.order();
  a.force_order = force_basis_.order();
  a.near_radius = near_radius_;
  a.reference_displacement = d_ref_;
  std::unique_ptr<FieldTable> shared;
  if (case_.handheld()) shared = shareLoads(greens);
  report_.series_seconds = series_watch.seconds();

  const Stopwatch fit_watch;
  if (case_.handheld()) makeCompact();
  fit(table, shared ? *shared : greens);  // by each position's own radius
  report_.fit_seconds = fit_watch.seconds();
  data_.contact_domain_radius =
      leastWithinTwoRings(setup_.surface.faces, setup_.positions.nodes, data_.contact_domain_radius);

  if (case_.handheld()) return std::move(data_);  // edges are for fields that are more exact
  const Stopwatch edge_watch;
  storeEdgeFields(setup_, factor_, patches_, basis_.order(), options_, data_);
  report_.series_seconds += edge_watch.seconds();
  return std::move(data_);
}

/// Nodes where floats can say that they are, so that the file's mesh is the one that is solved. Moves them by less than 1e-7 of
/// the organ's size: floats have 24 bits, of which the middle of an edge needs one more than its ends.
mesh::TetMesh inFloats(mesh::TetMesh mesh) {
  double largest = 0.0;
  for (const Vec3& X : mesh.nodes) largest = std::max(largest, X.cwiseAbs().maxCoeff());
  int exponent = 0;
  (void)std::frexp(largest, &exponent);
  const double step = std::ldexp(1.0, exponent - 23);
  for (Vec3& X : mesh.nodes) X = step * (X / step).array().round().matrix();
  for (std::size_t t = 0; t < mesh.midsides.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [one, other] = mesh::kTetEdges[e];
      mesh.nodes[at(mesh.midsides[t][e])] =
          0.5 * (mesh.nodes[at(mesh.tetrahedra[t][at(one)])] + mesh.nodes[at(mesh.tetrahedra[t][at(other)])]);
    }
  return mesh;
}

std::vector<SeriesOrders> triedOrders(const Case& c) {
  if (!c.handheld()) return {kTravelOrders.begin(), kTravelOrders.end()};
  if (!c.travel) return {c.orders()};
  if (*c.travel <= Case::kHandheldTravel) return {SeriesOrders::of(3)};
  return {SeriesOrders::of(5), {5, 8}};
}

}  // namespace

modelfile::ModelData buildDisplacementSeries(const Case& c, const mesh::TetMesh& organ,
                                             const BuildOptions& options, BuildReport& report) {
  const mesh::TetMesh mesh = c.handheld() ? inFloats(organ) : organ;
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
  if (c.travel || c.handheld()) {
    const Stopwatch orders_watch;
    report.travel = ordersFor(c.travelOrDefault(), setup, factor, options, triedOrders(c));
    chosen.order = report.travel->orders.fields;
    chosen.force_order = report.travel->orders.answer;
    report.orders_seconds = orders_watch.seconds();
  }
  return Builder(chosen, mesh, setup, factor, options, report).run();
}

}  // namespace palpate::solver
