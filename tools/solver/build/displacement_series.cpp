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
#include "tools/solver/build/domain_rings.h"
#include "tools/solver/build/linear_answers.h"
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
  Builder(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options, BuildReport& report);
  modelfile::ModelData run();

 private:
  void storePosition(const SeriesSolver& series, int lane, std::size_t position, const SeriesRadii& radii);
  void solveGreens(const Cholesky& factor, FieldTable& table);
  void fit(const FieldTable& table);
  void storeGreens(const FieldTable& table, const FarField& far);
  void storeNearField(const FieldTable& table, const FarField& far);
  [[nodiscard]] double scale(int k) const {
    return std::pow(d_ref_, force_basis_[k][0] + force_basis_[k][1] + force_basis_[k][2]);
  }
  [[nodiscard]] Mat3 stiffnessAt(std::size_t position) const;

  const Case& case_;
  const mesh::TetMesh& mesh_;
  BuildOptions options_;
  BuildReport& report_;
  MonomialBasis basis_;        ///< of the fields
  MonomialBasis force_basis_;  ///< of the force; begins with the monomials of the fields
  SolverSetup setup_;
  double d_ref_;        ///< half a patch width: the travel at which the fit weighs the orders
  double near_radius_;  ///< rho, m
  ContactPatches patches_;
  std::vector<std::int32_t>
      sources_;                  ///< nodes that carry load: the contact positions, then others in patches
  std::vector<NearNodes> near_;  ///< of each source
  std::vector<Mat3> scale_;      ///< of each source's linear columns, N/m
  modelfile::ModelData data_;
};

/// Near fields of orders of two and more leave out what is less than this part of the travel at a node.
constexpr double kUnseen = 2e-4;

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
      near_radius_(c.nearRadiusOrDefault(setup_.patch_radius)),
      patches_(setup_.surface.graph, freeNodes(setup_.model, setup_.surface), setup_.patch_radius,
               setup_.positions.nodes),
      sources_(loadedNodes(setup_, patches_)) {
  for (const std::int32_t node : sources_)
    near_.push_back(nearNodes(setup_.surface, setup_.surface.positions[at(node)], near_radius_));
  checkNearBytes(near_radius_, near_, basis_.size());
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

/// K at a contact position, from the linear part of its force.
Mat3 Builder::stiffnessAt(std::size_t position) const {
  const double* const f = data_.contact_force.data() + 3 * position * at(force_basis_.size());
  return Eigen::Map<const Mat3>(f) / d_ref_;
}

/// The linear columns of the table: the fields of unit loads at single nodes, times the stiffness of the patch there, so
/// that they have the size of a patch's field per travel and one measure of errors holds for all columns.
void Builder::solveGreens(const Cholesky& factor, FieldTable& table) {
  const std::size_t M = setup_.positions.nodes.size();
  constexpr double kWidest = 6.5;  // of a patch's nodes, in a
  Mat3 mean = Mat3::Zero();
  for (std::size_t p = 0; p < M; ++p) mean += stiffnessAt(p) / static_cast<double>(M);
  scale_.clear();
  for (std::size_t i = 0; i < sources_.size(); ++i) scale_.push_back(i < M ? stiffnessAt(i) : mean);
  CloseGreens close(setup_.surface, sources_, kWidest * setup_.patch_radius);
  Progress progress("nodal Green's functions", sources_.size(), options_.quiet);
  std::vector<std::unique_ptr<NodalGreens>> solvers(at(options_.workers));
  const std::size_t chunk = NodalGreens::kMost;
  parallelFor(options_.workers, (sources_.size() + chunk - 1) / chunk, [&](int worker, std::size_t number) {
    auto& solver = solvers[at(worker)];
    if (!solver) solver = std::make_unique<NodalGreens>(setup_.model, factor, setup_.surface);
    const std::size_t first = number * chunk, count = std::min(chunk, sources_.size() - first);
    solver->solve(std::span(sources_).subspan(first, count));
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::MatrixXd& W = solver->of(i);
      close.keep(first + i, W);
      const Eigen::MatrixXf scaled = (W * scale_[first + i]).cast<float>();
      table.write(first + i, 0, {scaled.data(), static_cast<std::size_t>(scaled.size())});
    }
    progress.advance(count);
  });
  data_.contact_stiffness = patchStiffness(setup_, patches_, close, options_.workers);
}

void Builder::fit(const FieldTable& table) {
  std::vector<FitSource> sources;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Vec3& place = setup_.surface.positions[at(sources_[i])];
    // Large travel is rare and must not cost accuracy at small travel.
    const double ball =
        i < data_.contact_domain_radius.size() ? std::min(d_ref_, data_.contact_domain_radius[i]) : d_ref_;
    sources.push_back({place, fitWeights(setup_.surface, place, near_radius_), ball, d_ref_});
  }
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
  storeGreens(table, far);
  storeNearField(table, far);
}

/// The linear part by unit loads at nodes: amplitudes of the modes, and window (W_i - what the modes give) near node i.
void Builder::storeGreens(const FieldTable& table, const FarField& far) {
  const std::size_t C = at(basis_.size()), n = static_cast<std::size_t>(far.X.cols());
  data_.green_node = sources_;
  data_.green_offset.push_back(0);
  for (const NearNodes& near : near_) {
    data_.green_offset.push_back(data_.green_offset.back() + static_cast<std::int64_t>(near.nodes.size()));
    data_.green_near_node.insert(data_.green_near_node.end(), near.nodes.begin(), near.nodes.end());
  }
  data_.green_Y.resize(sources_.size() * 3 * n);
  data_.green_near.resize(9 * data_.green_near_node.size());
  parallelFor(options_.workers, sources_.size(), [&](int, std::size_t i) {
    std::vector<float> fields(C * table.rows());
    table.read(i, fields);
    const Eigen::Matrix3f per_load = scale_[i].inverse().cast<float>();  // the table's columns are per travel
    const Eigen::MatrixXf Y =
        far.Y.middleCols(static_cast<Eigen::Index>(i * C), 3) * (per_load / static_cast<float>(d_ref_));
    Eigen::Map<Eigen::MatrixXf>(data_.green_Y.data() + 3 * n * i, far.X.cols(), 3) = Y;
    const Eigen::Map<const Eigen::MatrixXf> U(fields.data(), static_cast<Eigen::Index>(table.rows()), 3);
    const NearNodes& near = near_[i];
    const std::size_t K = near.nodes.size();
    float* const out = data_.green_near.data() + 9 * data_.green_offset[i];
    for (std::size_t j = 0; j < K; ++j) {
      const Eigen::Index row = 3 * near.nodes[j];
      const Eigen::Matrix3f modes = far.X.middleRows<3>(row) * Y;
      const Eigen::Matrix3f missed = near.window[j] * (U.middleRows<3>(row) * per_load - modes);
      for (std::size_t load = 0; load < 3; ++load)
        Eigen::Map<Eigen::Vector3f>(out + 3 * (load * K + j)) = missed.col(static_cast<Eigen::Index>(load));
    }
  });
}

/// Orders of two and more: amplitudes of the modes, and window (U_alpha - what the modes give) at the nodes near each position
/// where that is more than a small part of the travel.
void Builder::storeNearField(const FieldTable& table, const FarField& far) {
  const std::size_t M = setup_.positions.nodes.size(), n = static_cast<std::size_t>(far.X.cols());
  const Eigen::Index C = basis_.size(), linear = 3;
  data_.modes_Y.resize(M * static_cast<std::size_t>(C - linear) * n);
  std::vector<std::vector<std::int32_t>> nodes(M);
  std::vector<std::vector<float>> blocks(M);
  parallelFor(options_.workers, M, [&](int, std::size_t position) {
    std::vector<float> fields(static_cast<std::size_t>(C) * table.rows());
    table.read(position, fields);
    const auto Y = far.Y.middleCols(static_cast<Eigen::Index>(position) * C + linear, C - linear);
    Eigen::Map<Eigen::MatrixXf>(data_.modes_Y.data() + position * static_cast<std::size_t>(C - linear) * n,
                                Y.rows(), Y.cols()) = Y;
    Eigen::Map<const Eigen::MatrixXf> U(fields.data(), static_cast<Eigen::Index>(table.rows()), C);
    const double least = kUnseen * std::min(d_ref_, data_.contact_domain_radius[position]);
    const double x = std::min(1.0, data_.contact_domain_radius[position] / d_ref_);
    std::vector<Eigen::Matrix3Xf> kept;
    const NearNodes& near = near_[position];
    for (std::size_t j = 0; j < near.nodes.size(); ++j) {
      const Eigen::Index row = 3 * near.nodes[j];
      Eigen::Matrix3Xf u = -far.X.middleRows<3>(row) * Y;
      double size = 0.0;
      for (Eigen::Index k = 0; k < C - linear; ++k) {
        const int alpha = static_cast<int>(k + linear);
        u.col(k) += U.block<3, 1>(row, alpha) * static_cast<float>(scale(alpha));
        const MultiIndex& a = force_basis_[alpha];
        size += static_cast<double>(u.col(k).norm()) * std::pow(x, a[0] + a[1] + a[2]);
      }
      if (static_cast<double>(near.window[j]) * size < least) continue;
      nodes[position].push_back(near.nodes[j]);
      kept.emplace_back(near.window[j] * u);
    }
    for (Eigen::Index k = 0; k < C - linear; ++k)
      for (const Eigen::Matrix3Xf& u : kept)
        blocks[position].insert(blocks[position].end(), u.col(k).data(), u.col(k).data() + 3);
  });
  data_.near_offset.push_back(0);
  for (std::size_t p = 0; p < M; ++p) {
    data_.near_offset.push_back(data_.near_offset.back() + static_cast<std::int64_t>(nodes[p].size()));
    data_.near_node.insert(data_.near_node.end(), nodes[p].begin(), nodes[p].end());
    data_.near_field.insert(data_.near_field.end(), blocks[p].begin(), blocks[p].end());
  }
}

modelfile::ModelData Builder::run() {
  const Stopwatch factor_watch;
  Cholesky factor(setup_.model);
  factorizeAtRest(factor, setup_, mesh_, case_);
  report_.factor_seconds = factor_watch.seconds();

  const Stopwatch series_watch;
  FieldTable table(options_.scratch, sources_.size(), at(basis_.size()), 3 * setup_.surface.nodes.size());
  solveAllSeries(setup_, mesh_, case_, factor, SeriesKind::kDisplacement, options_, table,
                 [&](const SeriesSolver& series, int lane, std::size_t position, const SeriesRadii& radii) {
                   storePosition(series, lane, position, radii);
                 });
  for (std::vector<double>* radius : {&data_.contact_domain_radius, &data_.contact_series_radius})
    *radius = leastWithinTwoRings(setup_.surface.triangles, setup_.positions.nodes, *radius);
  solveGreens(factor, table);
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
