// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/build_model_parts.h"

#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/index.h"
#include "tools/solver/base/lanes.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/fit/spatial_order.h"

namespace palpate::solver {

void factorizeAtRest(Cholesky& factor, const SolverSetup& setup, const mesh::TetMesh& mesh, const Case& c) {
  factor.factorize(Eigen::VectorXd::Zero(3 * setup.model.nodeCount()));
  const std::optional<int> unknown = factor.indefiniteAt();
  for (int node = 0; unknown && node < setup.model.nodeCount(); ++node)
    if (setup.model.isFree(node) && setup.model.dof(node) == *unknown - *unknown % 3)
      throw std::runtime_error(c.mesh.string() + ": node " + std::to_string(mesh.node_tags[index(node)]) +
                               ": the stiffness is not positive definite; is the organ held by \"" + c.fixed +
                               "\" or by springs?");
}

DomainCriteria criteriaOf(const Case& c) {
  DomainCriteria criteria;
  criteria.answer_error = c.forceErrorOrDefault();
  criteria.field_error = c.fieldErrorOrDefault();
  return criteria;
}

Blocks blocksOf(const SolverSetup& setup, std::span<const std::int32_t> nodes, std::size_t part,
                const Ranks& ranks) {
  std::vector<Vec3> places;
  for (const std::int32_t node : nodes) places.push_back(setup.surface.positions[index(node)]);
  return {spatialOrder(places), part, Blocks::kMost, ranks};
}

void solveAllSeries(const SolverSetup& setup, const mesh::TetMesh& mesh, const Case& c,
                    const Cholesky& factor, SeriesKind kind, const BuildOptions& options, FieldTable& table,
                    const SeriesSink& sink) {
  const ContactPositions& positions = setup.positions;
  const Blocks& blocks = table.blocks();
  const std::size_t block = table.coefficients() * table.rows();
  const auto positionsOf = [&](std::size_t chunk) {
    const std::size_t first = chunk * kLanes;
    return blocks.order().subspan(first, std::min<std::size_t>(kLanes, blocks.order().size() - first));
  };
  Progress progress("series, contact positions", blocks.ownEnd() - blocks.ownBegin(), options.quiet);
  std::vector<std::unique_ptr<SeriesSolver>> solvers(index(options.workers));
  std::vector<std::vector<float>> fields(index(options.workers));  // of the chunk that a worker has
  std::vector<std::vector<double>> numbers(positions.nodes.size(), std::vector<double>(sink.count));
  const auto restore = [&](std::size_t chunk, record::ByteSource& kept) {
    std::vector<float> room;
    for (const std::int32_t position : positionsOf(chunk)) {
      if (kept.get<std::uint32_t>() != table.checksum(index(position), room))
        throw record::RecordError("the scratch file has other fields");
      getArray(kept, numbers[index(position)]);
    }
    progress.skip(positionsOf(chunk).size());
  };
  const auto solve = [&](int worker, std::size_t chunk) {
    auto& solver = solvers[index(worker)];
    if (!solver) solver = std::make_unique<SeriesSolver>(setup.model, factor, c.orders(), kind);
    const auto own = positionsOf(chunk);
    std::vector<Patch> patches;
    for (const std::int32_t position : own) patches.push_back(positions.patches[index(position)]);
    solver->solve(patches);
    const std::vector<SeriesRadii> radii = solver->domainRadii(criteriaOf(c));
    std::vector<float>& chunk_fields = fields[index(worker)];
    chunk_fields.resize(own.size() * block);
    solver->copyDisplacements(setup.surface.nodes, chunk_fields);
    record::Bytes kept;
    for (std::size_t lane = 0; lane < own.size(); ++lane) {
      const std::size_t position = index(own[lane]);
      if (!(radii[lane].domain > 0.0))
        throw std::runtime_error(
            c.mesh.string() + ": node " +
            std::to_string(mesh.node_tags[index(setup.surface.nodes[index(positions.nodes[position])])]) +
            ": the series has no domain; is the organ held by \"" + c.fixed + "\"?");
      const std::span<const float> own_fields = std::span(chunk_fields).subspan(lane * block, block);
      numbers[position] = sink.numbers(*solver, static_cast<int>(lane), radii[lane]);
      table.write(position, own_fields);
      record::put(kept, FieldTable::checksum(own_fields));
      putArray(kept, numbers[position]);
    }
    progress.advance(own.size());
    return kept;
  };
  parallelParts(options.workers, partsOf(blocks, kLanes), options.journal("series"), restore, solve);
  share(blocks, [&](std::int32_t position) { return std::span(numbers[index(position)]); });
  for (std::size_t position = 0; position < numbers.size(); ++position)
    sink.store(position, numbers[position]);
}

void storeAttributes(const Case& c, const SolverSetup& setup, ModelAttributes& attributes) {
  attributes.law = c.law;
  attributes.E = c.E;
  attributes.nu = c.nu;
  attributes.patch_radius = setup.patch_radius;
}

}  // namespace palpate::solver
