// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/build_model_parts.h"

#include <memory>
#include <stdexcept>
#include <string>

#include "tools/solver/base/lanes.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"

namespace palpate::solver {

namespace {

std::size_t at(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// U_alpha at the surface nodes, [k][node][3].
std::vector<float> surfaceFields(const SeriesSolver& series, int lane, const PatchSurface& surface) {
  std::vector<float> fields;
  fields.reserve(at(series.basis().size()) * surface.nodes.size() * 3);
  for (int k = 0; k < series.basis().size(); ++k)
    for (const std::int32_t node : surface.nodes) {
      const Vec3 u = series.displacement(lane, k, node);
      for (int c = 0; c < 3; ++c) fields.push_back(static_cast<float>(u[c]));
    }
  return fields;
}

}  // namespace

void factorizeAtRest(Cholesky& factor, const SolverSetup& setup, const Case& c) {
  factor.factorize(Eigen::VectorXd::Zero(3 * setup.model.nodeCount()));
  if (!factor.positiveDefinite())
    throw std::runtime_error(c.mesh.string() +
                             ": the stiffness is not positive definite; is the organ held by \"" + c.fixed +
                             "\"?");
}

void solveAllSeries(const SolverSetup& setup, const mesh::TetMesh& mesh, const Case& c,
                    const Cholesky& factor, SeriesKind kind, const BuildOptions& options, FieldTable& table,
                    const SeriesSink& sink) {
  const ContactPositions& positions = setup.positions;
  const std::size_t count = positions.nodes.size();
  Progress progress("series, contact positions", count, options.quiet);
  std::vector<std::unique_ptr<SeriesSolver>> solvers(at(options.workers));
  parallelFor(options.workers, (count + kLanes - 1) / kLanes, [&](int worker, std::size_t chunk) {
    auto& solver = solvers[at(worker)];
    if (!solver) solver = std::make_unique<SeriesSolver>(setup.model, factor, c.orderOrDefault(), kind);
    const std::size_t first = chunk * kLanes;
    const std::size_t lanes = std::min<std::size_t>(kLanes, count - first);
    solver->solve(std::span(positions.patches).subspan(first, lanes));
    const std::vector<double> radii = solver->domainRadii({});
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (!(radii[lane] > 0.0))
        throw std::runtime_error(
            c.mesh.string() + ": node " +
            std::to_string(mesh.node_tags[at(setup.surface.nodes[at(positions.nodes[first + lane])])]) +
            ": the series has no domain; is the organ held by \"" + c.fixed + "\"?");
      sink(*solver, static_cast<int>(lane), first + lane, radii[lane]);
      table.write(first + lane, surfaceFields(*solver, static_cast<int>(lane), setup.surface));
    }
    progress.advance(lanes);
  });
}

void storeAttributes(const Case& c, const SolverSetup& setup, ModelAttributes& attributes) {
  attributes.law = c.law;
  attributes.E = c.E;
  attributes.nu = c.nu;
  attributes.patch_radius = setup.patch_radius;
}

}  // namespace palpate::solver
