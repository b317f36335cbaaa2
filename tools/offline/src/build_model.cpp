// SPDX-License-Identifier: Apache-2.0
#include "palpate/offline/build_model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "palpate/offline/far_field.h"
#include "palpate/offline/lanes.h"
#include "palpate/offline/parallel.h"
#include "palpate/offline/progress.h"
#include "palpate/offline/series.h"

namespace palpate::offline {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", x);
  return buffer;
}

/// The three parts as they are filled.
class Builder {
 public:
  Builder(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options, BuildReport& report);
  modelfile::ModelData run();

 private:
  void solveSeries(const Cholesky& factor, FieldTable& table);
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
  double d_ref_;  ///< half a patch width: the travel at which the fit weighs the orders against each other
  std::vector<NearNodes> near_;
  modelfile::ModelData data_;
};

/// The near field is part of the model, and stands in memory here and in the server.
void checkNearBytes(const Case& c, std::span<const NearNodes> near, int coefficients) {
  constexpr double kMost = 2147483648.0;  // bytes
  double bytes = 0.0;
  for (const NearNodes& nodes : near) bytes += 12.0 * coefficients * static_cast<double>(nodes.nodes.size());
  if (bytes > kMost)
    throw CaseError("model.near_radius = " + text(c.near_radius) + " m makes a near field of " +
                    text(1e-6 * bytes) + " MB, at most " + text(1e-6 * kMost) + " MB are taken");
}

Builder::Builder(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options, BuildReport& report)
    : case_(c),
      mesh_(mesh),
      options_(options),
      report_(report),
      basis_(c.order),
      force_basis_(SeriesSolver::answerOrder(c.order)),
      setup_(c, mesh),
      d_ref_(0.5 * setup_.patch_radius) {
  for (const std::int32_t node : setup_.positions.nodes)
    near_.push_back(nearNodes(setup_.surface, setup_.surface.positions[at(node)], c.near_radius));
  checkNearBytes(c, near_, basis_.size());
  const std::size_t coefficients = static_cast<std::size_t>(force_basis_.size());
  data_.contact_force.resize(setup_.positions.nodes.size() * coefficients * 3);
  data_.contact_domain_radius.resize(setup_.positions.nodes.size());
}

void Builder::storePosition(const SeriesSolver& series, int lane, std::size_t position, double radius) {
  if (!(radius > 0.0))
    throw std::runtime_error(
        case_.mesh.string() + ": node " +
        std::to_string(mesh_.node_tags[at(setup_.surface.nodes[at(setup_.positions.nodes[position])])]) +
        ": the series has no domain; is the organ held by \"" + case_.fixed + "\"?");
  data_.contact_domain_radius[position] = radius;
  const std::size_t coefficients = at(force_basis_.size());
  for (int k = 0; k < force_basis_.size(); ++k) {
    const Vec3 f = series.answer(lane, k) * scale(k);
    for (int c = 0; c < 3; ++c) data_.contact_force[(position * coefficients + at(k)) * 3 + at(c)] = f[c];
  }
}

void Builder::solveSeries(const Cholesky& factor, FieldTable& table) {
  const std::size_t count = setup_.positions.nodes.size();
  const std::size_t chunks = (count + kLanes - 1) / kLanes;
  Progress progress("series, contact positions", count, options_.quiet);
  std::vector<std::unique_ptr<SeriesSolver>> solvers(at(options_.workers));
  parallelFor(options_.workers, chunks, [&](int worker, std::size_t chunk) {
    auto& solver = solvers[at(worker)];
    if (!solver) solver = std::make_unique<SeriesSolver>(setup_.model, factor, basis_.order());
    const std::size_t first = chunk * kLanes;
    const std::size_t lanes = std::min<std::size_t>(kLanes, count - first);
    solver->solve(std::span(setup_.positions.patches).subspan(first, lanes));
    const std::vector<double> radii = solver->domainRadii({});
    std::vector<float> fields(at(basis_.size()) * setup_.surface.nodes.size() * 3);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      storePosition(*solver, static_cast<int>(lane), first + lane, radii[lane]);
      float* out = fields.data();
      for (int k = 0; k < basis_.size(); ++k)
        for (const std::int32_t node : setup_.surface.nodes) {
          const Vec3 u = solver->displacement(static_cast<int>(lane), k, node);
          for (int c = 0; c < 3; ++c) *out++ = static_cast<float>(u[c]);
        }
      table.write(first + lane, fields);
    }
    progress.advance(lanes);
  });
}

void Builder::fit(const FieldTable& table) {
  std::vector<FitWeights> weights;
  for (const std::int32_t node : setup_.positions.nodes)
    weights.push_back(fitWeights(setup_.surface, setup_.surface.positions[at(node)], case_.near_radius));
  const FitProblem problem{table, basis_, setup_.surface.areas, weights, data_.contact_domain_radius, d_ref_};
  FitOptions options;
  options.modes = case_.modes;
  options.sweeps = case_.sweeps;
  options.workers = options_.workers;
  options.quiet = options_.quiet;
  const FarField far = fitFarField(problem, options);
  report_.fit_errors = far.errors;
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
    std::vector<float> fields;
    table.read(position, 1, fields);
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
  auto start = std::chrono::steady_clock::now();
  Cholesky factor(setup_.model);
  factor.factorize(Eigen::VectorXd::Zero(3 * setup_.model.nodeCount()));
  if (!factor.positiveDefinite())
    throw std::runtime_error(case_.mesh.string() +
                             ": the stiffness is not positive definite; is the organ held by \"" +
                             case_.fixed + "\"?");
  report_.factor_seconds = secondsSince(start);

  start = std::chrono::steady_clock::now();
  FieldTable table(options_.scratch, setup_.positions.nodes.size(), at(basis_.size()),
                   3 * setup_.surface.nodes.size());
  solveSeries(factor, table);
  report_.series_seconds = secondsSince(start);

  start = std::chrono::steady_clock::now();
  fit(table);
  report_.fit_seconds = secondsSince(start);

  storeOrgan(setup_, mesh_, data_);
  ModelAttributes& a = data_.attributes;
  a.law = case_.law;
  a.E = case_.E;
  a.nu = case_.nu;
  a.order = case_.order;
  a.force_order = force_basis_.order();
  a.patch_radius = setup_.patch_radius;
  a.near_radius = case_.near_radius;
  a.reference_displacement = d_ref_;
  return std::move(data_);
}

}  // namespace

modelfile::ModelData buildModel(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options,
                                BuildReport& report) {
  return Builder(c, mesh, options, report).run();
}

}  // namespace palpate::offline
