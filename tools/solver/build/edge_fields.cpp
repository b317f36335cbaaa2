// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/edge_fields.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/index.h"
#include "core/base/multi_index.h"
#include "core/record/crc32.h"
#include "tools/solver/base/journal.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/build/edge_surplus.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {

namespace {

constexpr int kMostDegree = 3;      ///< of what edges add: a fourth costs more than both and gives a tenth
constexpr std::size_t kTried = 16;  ///< edges, before the others are solved
constexpr double kSmall = 0.25;     ///< part of the asked error that edges may add and be left out

/// The second largest of what some edges add.
double secondOf(const EdgeFields& edges, const std::vector<Surplus>& surplus,
                const std::vector<std::size_t>& tried, double travel) {
  std::vector<double> added;
  for (const std::size_t edge : tried) added.push_back(edges.added(surplus[edge], travel));
  std::sort(added.begin(), added.end(), std::greater<>());
  return added[std::min<std::size_t>(1, added.size() - 1)];
}

/// `count` entries spread over a list, then the rest.
std::pair<std::vector<std::size_t>, std::vector<std::size_t>> spread(const std::vector<std::size_t>& list,
                                                                     std::size_t count) {
  std::pair<std::vector<std::size_t>, std::vector<std::size_t>> parts;
  for (std::size_t i = 0; i < list.size(); ++i)
    (i * count / list.size() != (i + 1) * count / list.size() ? parts.first : parts.second)
        .push_back(list[i]);
  return parts;
}

/// Mixing bounds how far the ends of edges are trusted.
void limitDomains(const EdgeFields& edges, const std::vector<Surplus>& surplus,
                  const std::vector<std::size_t>& chosen, double error, std::vector<double>& domains) {
  for (const std::size_t edge : chosen)
    for (const std::size_t end : edges.ends(edge)) {
      const Surplus& own = surplus[edge];
      domains[end] = std::min({domains[end], own.force_radius, edges.radius(own, domains[end], error)});
    }
}

/// Beyond some radius what is left out of all edges is too much.
void capDomains(const std::function<bool(double)>& is_small, std::vector<double>& domains) {
  const double cap = largestTrusted(*std::max_element(domains.begin(), domains.end()), is_small);
  for (double& domain : domains) domain = std::min(domain, cap);
}

void store(const std::vector<Surplus>& surplus, modelfile::ModelData& data) {
  data.edge_offset.push_back(0);
  for (const Surplus& own : surplus) {
    data.edge_offset.push_back(data.edge_offset.back() + static_cast<std::int64_t>(own.nodes.size()));
    data.edge_node.insert(data.edge_node.end(), own.nodes.begin(), own.nodes.end());
    data.edge_field.insert(data.edge_field.end(), own.field.begin(), own.field.end());
  }
}

/// Of modes and near fields.
std::uint32_t fitChecksum(const modelfile::ModelData& data) {
  std::uint32_t checksum = 0;
  for (const std::vector<float>* const part : {&data.modes_X, &data.modes_Y, &data.near_field})
    checksum = record::crc32(
        {reinterpret_cast<const std::uint8_t*>(part->data()), part->size() * sizeof(float)}, checksum);
  return checksum;
}

}  // namespace

EdgeCounts edgeCounts(const SolverSetup& setup, int order) {
  EdgeCounts counts;
  counts.degree = std::min(order, kMostDegree);
  if (counts.degree < 2) return {};
  counts.coefficients = static_cast<double>(MonomialBasis(counts.degree).size()) - kLinearCoefficients;
  std::vector<std::uint8_t> is_position(setup.surface.nodes.size(), 0);
  for (const std::int32_t node : setup.positions.nodes) is_position[index(node)] = 1;
  std::set<std::pair<std::int32_t, std::int32_t>> seen;
  double nodes = 0.0;
  for (const auto& face : setup.surface.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [one, other] = std::minmax(face[k], face[(k + 1) % 3]);
      if (is_position[index(one)] == 0 || is_position[index(other)] == 0 || !seen.emplace(one, other).second)
        continue;
      const Vec3 &X = setup.surface.positions[index(one)], &Y = setup.surface.positions[index(other)];
      if ((X - Y).norm() <= kShortestEdge * setup.patch_radius) continue;
      if (counts.solved++ % 32 == 0)
        nodes +=
            32.0 * static_cast<double>(
                       nearNodes(setup.surface, 0.5 * (X + Y), kEdgeReach * setup.patch_radius).nodes.size());
    }
  counts.all = seen.size();
  if (counts.solved > 0) counts.nodes = nodes / static_cast<double>((counts.solved + 31) / 32 * 32);
  return counts;
}

EdgeChoice storeEdgeFields(const SolverSetup& setup, const Cholesky& factor, const ContactPatches& patches,
                           int order, const EdgeNeed& need, const BuildOptions& options,
                           modelfile::ModelData& data) {
  const int degree = std::min(order, kMostDegree);
  if (degree < 2) return {};
  const EdgeFields edges(setup, patches, degree, data);
  std::vector<std::size_t> chosen;
  for (std::size_t edge = 0; edge < edges.count(); ++edge)
    if (edges.isLong(edge)) chosen.push_back(edge);
  if (chosen.empty()) return {};
  std::vector<Surplus> surplus(edges.count());
  Progress progress("series, edge midpoints", chosen.size() / static_cast<std::size_t>(options.ranks->size()),
                    options.quiet);
  std::vector<std::unique_ptr<SeriesSolver>> solvers(static_cast<std::size_t>(options.workers));
  const std::string fit = std::to_string(fitChecksum(data));  // they add to what it leaves
  const auto solve = [&](const std::vector<std::size_t>& list, const std::string& name) {
    const auto edgesOf = [&](std::size_t chunk) {
      return std::span(list).subspan(chunk * kLanes,
                                     std::min<std::size_t>(kLanes, list.size() - chunk * kLanes));
    };
    const auto restore = [&](std::size_t chunk, record::ByteSource& kept) {
      for (const std::size_t edge : edgesOf(chunk)) {
        Surplus& own = surplus[edge];
        getArray(kept, own.nodes);
        getArray(kept, own.field);
        kept.get(own.force_radius);
      }
      progress.skip(edgesOf(chunk).size());
    };
    const auto work = [&](int worker, std::size_t chunk) {
      auto& solver = solvers[static_cast<std::size_t>(worker)];
      if (!solver) solver = std::make_unique<SeriesSolver>(setup.model, factor, SeriesOrders{degree, degree});
      const auto of = edgesOf(chunk);
      std::vector<Patch> loaded;
      PatchNodes room = patches.room();
      for (const std::size_t edge : of) loaded.push_back(edges.patch(edge, room));
      solver->solve(loaded);
      record::Bytes kept;
      for (std::size_t lane = 0; lane < of.size(); ++lane) {
        Surplus& own = surplus[of[lane]] = edges.surplus(*solver, static_cast<int>(lane), of[lane]);
        own.force_radius = edges.forceRadius(*solver, static_cast<int>(lane), of[lane], need.force_error);
        putArray(kept, own.nodes);
        putArray(kept, own.field);
        record::put(kept, own.force_radius);
      }
      progress.advance(of.size());
      return kept;
    };
    const Blocks blocks(list.size(), *options.ranks, kLanes);
    parallelParts(options.workers, partsOf(blocks, kLanes), options.journal(name + fit), restore, work);
    const auto of = [&](std::int32_t i) -> Surplus& { return surplus[list[index(i)]]; };
    shareLists(
        blocks, [&](std::int32_t i) -> auto& { return of(i).nodes; });
    shareLists(
        blocks, [&](std::int32_t i) -> auto& { return of(i).field; });
    share(blocks, [&](std::int32_t i) { return std::span(&of(i).force_radius, 1); });
  };
  const auto [tried, others] = spread(chosen, kTried);
  solve(tried, "tried-edges-");
  EdgeChoice choice{chosen.size(), 0, tried.size(), secondOf(edges, surplus, tried, need.travel)};
  if (choice.added <= kSmall * need.error) {
    capDomains([&](double d) { return secondOf(edges, surplus, tried, d) <= need.error; },
               data.contact_domain_radius);
    return choice;
  }
  solve(others, "edges-");
  choice.solved = chosen.size();
  limitDomains(edges, surplus, chosen, need.error, data.contact_domain_radius);
  data.edge_order = degree;
  store(surplus, data);
  return choice;
}

}  // namespace palpate::solver
