// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/displacement_series.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "core/base/multi_index.h"
#include "core/data/model_view.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/build/build_model_parts.h"
#include "tools/solver/fit/far_field.h"

namespace palpate::solver {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Of the asked error, what the modes may take at positions; interpolation between them needs the rest.
constexpr double kFitShare = 0.7;
constexpr int kFewModes = 100;  ///< to begin with, where their number is not given

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", x);
  return buffer;
}

/// Collects the three parts of the model.
class Builder {
 public:
  Builder(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options, BuildReport& report);
  modelfile::ModelData run();

 private:
  void storePosition(const SeriesSolver& series, int lane, std::size_t position, double radius);
  void fit(const FieldTable& table);
  void storeNearField(const FieldTable& table, const FarField& far);
  [[nodiscard]] double scale(int k) const {
    return std::pow(d_ref_, force_basis_[k][0] + force_basis_[k][1] + force_basis_[k][2]);
  }

  const Case& case_;
  const mesh::TetMesh& mesh_;
  BuildOptions options_;
  BuildReport& report_;
  MonomialBasis basis_;        ///< of the fields
  MonomialBasis force_basis_;  ///< of the force; begins with the monomials of the fields
  SolverSetup setup_;
  double d_ref_;        ///< half a patch width: the travel at which the fit weighs the orders
  double near_radius_;  ///< rho, m
  std::vector<NearNodes> near_;
  modelfile::ModelData data_;
};

/// The near field is part of the model; this program and the server hold all of it in memory.
void checkNearBytes(double near_radius, std::span<const NearNodes> near, int coefficients) {
  constexpr double kMost = 2147483648.0;  // bytes
  double bytes = 0.0;
  for (const NearNodes& nodes : near) bytes += 12.0 * coefficients * static_cast<double>(nodes.nodes.size());
  if (bytes > kMost)
    throw CaseError("model.near_radius = " + text(near_radius) + " m makes a near field of " +
                    text(1e-6 * bytes) + " MB; the limit is " + text(1e-6 * kMost) + " MB");
}

Builder::Builder(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options, BuildReport& report)
    : case_(c),
      mesh_(mesh),
      options_(options),
      report_(report),
      basis_(c.orderOrDefault()),
      force_basis_(SeriesSolver::answerOrder(c.orderOrDefault())),
      setup_(c, mesh),
      d_ref_(0.5 * setup_.patch_radius),
      near_radius_(c.nearRadiusOrDefault(setup_.patch_radius)) {
  for (const std::int32_t node : setup_.positions.nodes)
    near_.push_back(nearNodes(setup_.surface, setup_.surface.positions[at(node)], near_radius_));
  checkNearBytes(near_radius_, near_, basis_.size());
  const std::size_t coefficients = static_cast<std::size_t>(force_basis_.size());
  data_.contact_force.resize(setup_.positions.nodes.size() * coefficients * 3);
  data_.contact_domain_radius.resize(setup_.positions.nodes.size());
}

void Builder::storePosition(const SeriesSolver& series, int lane, std::size_t position, double radius) {
  data_.contact_domain_radius[position] = radius;
  const std::size_t coefficients = at(force_basis_.size());
  for (int k = 0; k < force_basis_.size(); ++k) {
    const Vec3 f = series.answer(lane, k) * scale(k);
    for (int c = 0; c < 3; ++c) data_.contact_force[(position * coefficients + at(k)) * 3 + at(c)] = f[c];
  }
}

void Builder::fit(const FieldTable& table) {
  std::vector<FitSource> sources;
  for (std::size_t s = 0; s < near_.size(); ++s) {
    const Vec3& place = setup_.surface.positions[at(setup_.positions.nodes[s])];
    // Large travel is rare and must not cost accuracy at small travel.
    sources.push_back({place, fitWeights(setup_.surface, place, near_radius_),
                       std::min(d_ref_, data_.contact_domain_radius[s]), d_ref_});
  }
  const FitProblem problem{table, basis_, setup_.surface.areas, setup_.surface.positions, sources, d_ref_};
  FitOptions options;
  report_.fit_asked = case_.modes ? 0.0 : kFitShare * case_.fieldErrorOrDefault();
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
  data_.modes_Y.assign(far.Y.data(), far.Y.data() + far.Y.size());
  storeNearField(table, far);
}

/// window (U_alpha - sum_k X_k Y_k,alpha) at the nodes near each position.
void Builder::storeNearField(const FieldTable& table, const FarField& far) {
  data_.near_offset.push_back(0);
  for (const NearNodes& near : near_) {
    data_.near_offset.push_back(data_.near_offset.back() + static_cast<std::int64_t>(near.nodes.size()));
    data_.near_node.insert(data_.near_node.end(), near.nodes.begin(), near.nodes.end());
  }
  const std::size_t coefficients = at(basis_.size());
  data_.near_field.resize(3 * coefficients * static_cast<std::size_t>(data_.near_offset.back()));
  parallelFor(options_.workers, near_.size(), [&](int, std::size_t position) {
    std::vector<float> fields(coefficients * table.rows());
    table.read(position, fields);
    const NearNodes& near = near_[position];
    float* out =
        data_.near_field.data() + 3 * coefficients * static_cast<std::size_t>(data_.near_offset[position]);
    for (int k = 0; k < basis_.size(); ++k) {
      const Eigen::VectorXf Y = far.Y.col(static_cast<Eigen::Index>(position * coefficients) + k);
      for (std::size_t j = 0; j < near.nodes.size(); ++j) {
        const Eigen::Index row = 3 * near.nodes[j];
        const Eigen::Vector3f modes = far.X.middleRows<3>(row) * Y;
        const float* U = fields.data() + at(k) * table.rows() + row;
        for (int c = 0; c < 3; ++c)
          *out++ = near.window[j] * (U[c] * static_cast<float>(scale(k)) - modes[c]);
      }
    }
  });
}

modelfile::ModelData Builder::run() {
  const Stopwatch factor_watch;
  Cholesky factor(setup_.model);
  factorizeAtRest(factor, setup_, mesh_, case_);
  report_.factor_seconds = factor_watch.seconds();

  const Stopwatch series_watch;
  FieldTable table(options_.scratch, setup_.positions.nodes.size(), at(basis_.size()),
                   3 * setup_.surface.nodes.size());
  solveAllSeries(setup_, mesh_, case_, factor, SeriesKind::kDisplacement, options_, table,
                 [&](const SeriesSolver& series, int lane, std::size_t position, double radius) {
                   storePosition(series, lane, position, radius);
                 });
  report_.series_seconds = series_watch.seconds();

  const Stopwatch fit_watch;
  fit(table);
  report_.fit_seconds = fit_watch.seconds();

  storeOrgan(setup_, mesh_, data_);
  ModelAttributes& a = data_.attributes;
  storeAttributes(case_, setup_, a);
  a.order = basis_.order();
  a.force_order = force_basis_.order();
  a.near_radius = near_radius_;
  a.reference_displacement = d_ref_;
  return std::move(data_);
}

}  // namespace

modelfile::ModelData buildDisplacementSeries(const Case& c, const mesh::TetMesh& mesh,
                                             const BuildOptions& options, BuildReport& report) {
  return Builder(c, mesh, options, report).run();
}

}  // namespace palpate::solver
