// SPDX-License-Identifier: Apache-2.0
#include "palpate/offline/build_model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "palpate/mesh/topology.h"
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

const std::vector<std::int32_t>& groupOf(const Case& c, const mesh::TetMesh& mesh, const std::string& name) {
  const auto found = mesh.groups.find(name);
  if (found != mesh.groups.end() && !found->second.empty()) return found->second;
  std::string list;
  for (const auto& [group, nodes] : mesh.groups) list += (list.empty() ? "" : ", ") + group;
  throw CaseError(c.mesh.string() + ": no group \"" + name +
                  "\" (there are: " + (list.empty() ? "none" : list) + ")");
}

std::vector<bool> accessibleNodes(const Case& c, const mesh::TetMesh& mesh, const FeModel& model,
                                  const ContactSurface& surface) {
  std::vector<bool> by_volume_node(mesh.nodes.size(), !c.accessible.has_value());
  if (c.accessible)
    for (const std::int32_t node : groupOf(c, mesh, *c.accessible)) by_volume_node[at(node)] = true;
  std::vector<bool> accessible;
  for (const std::int32_t node : surface.nodes)
    accessible.push_back(by_volume_node[at(node)] && model.isFree(node));
  if (std::none_of(accessible.begin(), accessible.end(), [](bool yes) { return yes; }))
    throw CaseError(c.mesh.string() + ": no accessible node on the free surface");
  return accessible;
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
  void storeMesh();
  void storeSurface();
  [[nodiscard]] double scale(int k) const {
    return std::pow(d_ref_, force_basis_[k][0] + force_basis_[k][1] + force_basis_[k][2]);
  }

  const Case& case_;
  const mesh::TetMesh& mesh_;
  BuildOptions options_;
  BuildReport& report_;
  MonomialBasis basis_;        ///< of the fields
  MonomialBasis force_basis_;  ///< of the force; begins with the monomials of the fields
  FeModel model_;
  ContactSurface surface_;
  double patch_radius_;
  double d_ref_;  ///< half a patch width: the travel at which the fit weighs the orders against each other
  ContactPositions positions_;
  std::vector<NearNodes> near_;
  modelfile::ModelData data_;
};

ContactSurface surfaceOf(const FeModel& model, const mesh::TetMesh& mesh) {
  mesh::BoundarySurface boundary = mesh::boundaryOf(mesh);
  return ContactSurface(model, std::move(boundary.nodes), std::move(boundary.triangles));
}

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", x);
  return buffer;
}

/// a as given or by default; a patch that reaches no neighbour is a point load, one as wide as the organ no
/// contact.
double patchRadius(const Case& c, const ContactSurface& surface) {
  const double edge = surface.medianEdge();
  const double a = c.patch_radius.value_or(1.3 * edge);
  Vec3 low = surface.positions.front(), high = low;
  for (const Vec3& x : surface.positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double widest = 0.5 * (high - low).minCoeff();
  if (!(a > edge / 3.0) || a > std::max(widest, 1.3 * edge))
    throw CaseError(c.mesh.string() + ": model.patch_radius = " + text(a) +
                    " m does not fit; the median surface edge is " + text(edge) +
                    " m, half the smallest extent " + text(widest) + " m");
  return a;
}

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
      force_basis_(SeriesSolver::forceOrder(c.order)),
      model_(mesh.nodes, mesh.tetrahedra, groupOf(c, mesh, c.fixed), {c.E, c.nu}),
      surface_(surfaceOf(model_, mesh)),
      patch_radius_(patchRadius(c, surface_)),
      d_ref_(0.5 * patch_radius_),
      positions_(contactPositions(model_, surface_, accessibleNodes(c, mesh, model_, surface_), patch_radius_,
                                  mesh)) {
  for (const std::int32_t node : positions_.nodes)
    near_.push_back(nearNodes(surface_, surface_.positions[at(node)], c.near_radius));
  checkNearBytes(c, near_, basis_.size());
  const std::size_t coefficients = static_cast<std::size_t>(force_basis_.size());
  data_.contact_force.resize(positions_.nodes.size() * coefficients * 3);
  data_.contact_domain_radius.resize(positions_.nodes.size());
}

void Builder::storePosition(const SeriesSolver& series, int lane, std::size_t position, double radius) {
  if (!(radius > 0.0))
    throw std::runtime_error(
        case_.mesh.string() + ": node " +
        std::to_string(mesh_.node_tags[at(surface_.nodes[at(positions_.nodes[position])])]) +
        ": the series has no domain; is the organ held by \"" + case_.fixed + "\"?");
  data_.contact_domain_radius[position] = radius;
  const std::size_t coefficients = at(force_basis_.size());
  for (int k = 0; k < force_basis_.size(); ++k) {
    const Vec3 f = series.force(lane, k) * scale(k);
    for (int c = 0; c < 3; ++c) data_.contact_force[(position * coefficients + at(k)) * 3 + at(c)] = f[c];
  }
}

void Builder::solveSeries(const Cholesky& factor, FieldTable& table) {
  const std::size_t count = positions_.nodes.size();
  const std::size_t chunks = (count + kLanes - 1) / kLanes;
  Progress progress("series, contact positions", count, options_.quiet);
  std::vector<std::unique_ptr<SeriesSolver>> solvers(at(options_.workers));
  parallelFor(options_.workers, chunks, [&](int worker, std::size_t chunk) {
    auto& solver = solvers[at(worker)];
    if (!solver) solver = std::make_unique<SeriesSolver>(model_, factor, basis_.order());
    const std::size_t first = chunk * kLanes;
    const std::size_t lanes = std::min<std::size_t>(kLanes, count - first);
    solver->solve(std::span(positions_.patches).subspan(first, lanes));
    const std::vector<double> radii = solver->domainRadii({});
    std::vector<float> fields(at(basis_.size()) * surface_.nodes.size() * 3);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      storePosition(*solver, static_cast<int>(lane), first + lane, radii[lane]);
      float* out = fields.data();
      for (int k = 0; k < basis_.size(); ++k)
        for (const std::int32_t node : surface_.nodes) {
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
  for (const std::int32_t node : positions_.nodes)
    weights.push_back(fitWeights(surface_, surface_.positions[at(node)], case_.near_radius));
  const FitProblem problem{table, basis_, surface_.areas, weights, data_.contact_domain_radius, d_ref_};
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

void Builder::storeSurface() {
  data_.position_of_node.assign(surface_.nodes.size(), -1);
  for (std::size_t p = 0; p < positions_.nodes.size(); ++p)
    data_.position_of_node[at(positions_.nodes[p])] = static_cast<std::int32_t>(p);
  data_.contact_node = positions_.nodes;
  data_.contact_accessible = positions_.accessible;
  for (const auto& t : surface_.triangles)
    data_.surface_triangles.insert(data_.surface_triangles.end(), t.begin(), t.end());
  for (std::size_t i = 0; i < surface_.nodes.size(); ++i) {
    data_.surface_mesh_tag.push_back(mesh_.node_tags[at(surface_.nodes[i])]);
    for (int c = 0; c < 3; ++c) data_.surface_positions.push_back(surface_.positions[i][c]);
  }
}

void Builder::storeMesh() {
  for (const Vec3& X : mesh_.nodes) data_.mesh_nodes.insert(data_.mesh_nodes.end(), X.data(), X.data() + 3);
  for (const auto& t : mesh_.tetrahedra)
    data_.mesh_tetrahedra.insert(data_.mesh_tetrahedra.end(), t.begin(), t.end());
  data_.mesh_node_tag = mesh_.node_tags;
  data_.mesh_tetrahedron_tag = mesh_.tetrahedron_tags;
  data_.mesh_fixed = model_.fixedNodes();
  data_.mesh_surface_node = surface_.nodes;
}

modelfile::ModelData Builder::run() {
  auto start = std::chrono::steady_clock::now();
  Cholesky factor(model_);
  factor.factorize(Eigen::VectorXd::Zero(3 * model_.nodeCount()));
  if (!factor.positiveDefinite())
    throw std::runtime_error(case_.mesh.string() +
                             ": the stiffness is not positive definite; is the organ held by \"" +
                             case_.fixed + "\"?");
  report_.factor_seconds = secondsSince(start);

  start = std::chrono::steady_clock::now();
  FieldTable table(options_.scratch, positions_.nodes.size(), at(basis_.size()), 3 * surface_.nodes.size());
  solveSeries(factor, table);
  report_.series_seconds = secondsSince(start);

  start = std::chrono::steady_clock::now();
  fit(table);
  report_.fit_seconds = secondsSince(start);

  storeSurface();
  storeMesh();
  ModelAttributes& a = data_.attributes;
  a.law = case_.law;
  a.E = case_.E;
  a.nu = case_.nu;
  a.order = case_.order;
  a.force_order = force_basis_.order();
  a.patch_radius = patch_radius_;
  a.near_radius = case_.near_radius;
  a.reference_displacement = d_ref_;
  return std::move(data_);
}

}  // namespace

ContactPositions contactPositions(const FeModel& model, const ContactSurface& surface,
                                  const std::vector<bool>& accessible, double patch_radius,
                                  const mesh::TetMesh& mesh) {
  // A helper needs enough of its patch on free nodes to say something of its own.
  constexpr double kEnough = 0.05;
  std::vector<bool> wanted = accessible;
  for (const auto& t : surface.triangles)
    if (std::any_of(t.begin(), t.end(), [&](std::int32_t node) { return accessible[at(node)]; }))
      for (const std::int32_t node : t) wanted[at(node)] = true;
  ContactPositions positions;
  for (const bool helpers : {false, true}) {
    for (std::size_t node = 0; node < surface.nodes.size(); ++node) {
      if (!wanted[node] || accessible[node] == helpers) continue;
      Patch patch = makePatch(model, surface, surface.atNode(static_cast<int>(node)), patch_radius);
      if (patch.nodes.empty() && !helpers)
        throw CaseError("node " + std::to_string(mesh.node_tags[at(surface.nodes[node])]) +
                        ": its contact patch lies on clamped nodes only");
      if (helpers && patch.free_share < kEnough) continue;
      positions.nodes.push_back(static_cast<std::int32_t>(node));
      positions.accessible.push_back(helpers ? 0 : 1);
      positions.patches.push_back(std::move(patch));
    }
  }
  return positions;
}

modelfile::ModelData buildModel(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options,
                                BuildReport& report) {
  return Builder(c, mesh, options, report).run();
}

}  // namespace palpate::offline
