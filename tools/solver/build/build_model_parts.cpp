// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/build_model_parts.h"

#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/solver/base/lanes.h"
#include "tools/solver/base/progress.h"

namespace palpate::solver {

namespace {

std::size_t at(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

void factorizeAtRest(Cholesky& factor, const SolverSetup& setup, const mesh::TetMesh& mesh, const Case& c) {
  factor.factorize(Eigen::VectorXd::Zero(3 * setup.model.nodeCount()));
  const std::optional<int> unknown = factor.indefiniteAt();
  for (int node = 0; unknown && node < setup.model.nodeCount(); ++node)
    if (setup.model.isFree(node) && setup.model.dof(node) == *unknown - *unknown % 3)
      throw std::runtime_error(c.mesh.string() + ": node " + std::to_string(mesh.node_tags[at(node)]) +
                               ": the stiffness is not positive definite; is the organ held by \"" + c.fixed +
                               "\" or by springs?");
}

DomainCriteria criteriaOf(const Case& c) {
  DomainCriteria criteria;
  criteria.answer_error = c.forceErrorOrDefault();
  criteria.field_error = c.fieldErrorOrDefault();
  return criteria;
}

void solveAllSeries(const SolverSetup& setup, const mesh::TetMesh& mesh, const Case& c,
                    const Cholesky& factor, SeriesKind kind, const BuildOptions& options, FieldTable& table,
                    const SeriesSink& sink) {
  const ContactPositions& positions = setup.positions;
  const std::size_t count = positions.nodes.size();
  const std::size_t block = table.coefficients() * table.rows();
  const auto lanesOf = [&](std::size_t chunk) {
    return std::min<std::size_t>(kLanes, count - chunk * kLanes);
  };
  Progress progress("series, contact positions", count, options.quiet);
  std::vector<std::unique_ptr<SeriesSolver>> solvers(at(options.workers));
  std::vector<std::vector<float>> fields(at(options.workers));  // of the chunk that a worker has
  const auto restore = [&](std::size_t chunk, record::ByteSource& kept) {
    std::vector<std::vector<double>> numbers(lanesOf(chunk));
    std::vector<float> room;
    for (std::size_t lane = 0; lane < numbers.size(); ++lane) {
      if (kept.get<std::uint32_t>() != table.checksum(chunk * kLanes + lane, room))
        throw record::RecordError("the scratch file has other fields");
      getArray(kept, numbers[lane]);
    }
    for (std::size_t lane = 0; lane < numbers.size(); ++lane)
      sink.store(chunk * kLanes + lane, numbers[lane]);
    progress.skip(numbers.size());
  };
  const auto solve = [&](int worker, std::size_t chunk) {
    auto& solver = solvers[at(worker)];
    if (!solver) solver = std::make_unique<SeriesSolver>(setup.model, factor, c.orders(), kind);
    const std::size_t first = chunk * kLanes, lanes = lanesOf(chunk);
    solver->solve(std::span(positions.patches).subspan(first, lanes));
    const std::vector<SeriesRadii> radii = solver->domainRadii(criteriaOf(c));
    std::vector<float>& chunk_fields = fields[at(worker)];
    chunk_fields.resize(lanes * block);
    solver->copyDisplacements(setup.surface.nodes, chunk_fields);
    record::Bytes kept;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (!(radii[lane].domain > 0.0))
        throw std::runtime_error(
            c.mesh.string() + ": node " +
            std::to_string(mesh.node_tags[at(setup.surface.nodes[at(positions.nodes[first + lane])])]) +
            ": the series has no domain; is the organ held by \"" + c.fixed + "\"?");
      const std::span<const float> own = std::span(chunk_fields).subspan(lane * block, block);
      const std::vector<double> numbers = sink.numbers(*solver, static_cast<int>(lane), radii[lane]);
      sink.store(first + lane, numbers);
      table.write(first + lane, own);
      record::put(kept, FieldTable::checksum(own));
      putArray(kept, numbers);
    }
    progress.advance(lanes);
    return kept;
  };
  parallelParts(options.workers, (count + kLanes - 1) / kLanes, options.journal("series"), restore, solve);
}

void storeAttributes(const Case& c, const SolverSetup& setup, ModelAttributes& attributes) {
  attributes.law = c.law;
  attributes.E = c.E;
  attributes.nu = c.nu;
  attributes.patch_radius = setup.patch_radius;
}

}  // namespace palpate::solver
