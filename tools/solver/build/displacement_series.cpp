// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/displacement_series.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/base/index.h"
#include "tools/solver/base/lanes.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/build/build_model_parts.h"
#include "tools/solver/build/displacement_builder.h"
#include "tools/solver/build/displacement_fields.h"
#include "tools/solver/build/edge_fields.h"
#include "tools/solver/build/linear_answers.h"
#include "tools/solver/build/mesh_error.h"
#include "tools/solver/build/travel_orders.h"
#include "tools/solver/series/nodal_greens.h"

namespace palpate::solver {

namespace {

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
      mesh.nodes[index(mesh.midsides[t][e])] = 0.5 * (mesh.nodes[index(mesh.tetrahedra[t][index(one)])] +
                                                      mesh.nodes[index(mesh.tetrahedra[t][index(other)])]);
    }
  return mesh;
}

std::vector<SeriesOrders> triedOrders(const Case& c) {
  if (!c.handheld()) return {kTravelOrders.begin(), kTravelOrders.end()};
  if (c.order || c.force_order) return {c.orders()};
  if (c.travelOrDefault() <= Case::kHandheldTravel) return {SeriesOrders::of(3)};
  return {SeriesOrders::of(5), {5, 8}};
}

void putOrders(record::Bytes& out, const TravelOrders& travel) {
  putArray(out, std::vector{travel.travel, travel.within});
  record::put(out, travel.orders);
  putArray(out, std::vector{travel.reaching, travel.places});
  putArray(out, travel.tried);
}

/// @throw record::RecordError  there are not so many
template <class T>
std::vector<T> numbersOf(record::ByteSource& in, std::size_t count) {
  std::vector<T> numbers;
  getArray(in, numbers);
  if (numbers.size() != count) throw record::RecordError("a record has another length");
  return numbers;
}

void getOrders(record::ByteSource& in, TravelOrders& travel) {
  const std::vector<double> shares = numbersOf<double>(in, 2);
  in.get(travel.orders);
  const std::vector<int> counts = numbersOf<int>(in, 2);
  getArray(in, travel.tried);
  travel = {shares[0], travel.orders, counts[0], counts[1], shares[1], travel.tried};
}

}  // namespace

DisplacementBuilder::DisplacementBuilder(const ChosenOrgan& organ, const BuildOptions& options,
                                         BuildReport& report)
    : case_(organ.chosen),
      mesh_(organ.mesh),
      options_(options),
      report_(report),
      basis_(case_.orders().fields),
      force_basis_(case_.orders().answer),
      setup_(organ.setup),
      factor_(organ.factor),
      d_ref_(0.5 * setup_.patch_radius),
      near_radius_(case_.nearRadiusOrDefault(setup_.patch_radius)),
      patches_(setup_.surface.graph, freeNodes(setup_.model, setup_.surface), setup_.patch_radius,
               setup_.positions.nodes),
      loaded_(loadedNodes(setup_, patches_)),
      near_(nearOf(setup_.positions.nodes)),
      near_loaded_(nearOf(loaded_)) {
  report_.median_edge = setup_.surface.medianEdge();
  checkNear();
  const std::size_t coefficients = static_cast<std::size_t>(force_basis_.size());
  data_.contact_force.resize(setup_.positions.nodes.size() * coefficients * 3);
  data_.contact_domain_radius.resize(setup_.positions.nodes.size());
  data_.contact_series_radius.resize(setup_.positions.nodes.size());
}

/// Both radii, and the force.
SeriesSink DisplacementBuilder::seriesSink() {
  const auto numbers = [this](const SeriesSolver& series, int lane, const SeriesRadii& radii) {
    std::vector<double> out{radii.domain, radii.series};
    for (int k = 0; k < force_basis_.size(); ++k) {
      const Vec3 f = series.answer(lane, k) * scale(k);
      out.insert(out.end(), f.begin(), f.end());
    }
    return out;
  };
  const auto store = [this](std::size_t position, std::span<const double> own) {
    data_.contact_domain_radius[position] = own[0];
    data_.contact_series_radius[position] = own[1];
    const std::span<const double> force = own.subspan(2);
    std::copy(force.begin(), force.end(),
              data_.contact_force.begin() + static_cast<std::ptrdiff_t>(position * force.size()));
  };
  return {2 + 3 * index(force_basis_.size()), numbers, store};
}

/// The fields of unit loads at single nodes.
void DisplacementBuilder::solveGreens(FieldTable& greens) {
  constexpr double kWidest = 6.5;  // of a patch's nodes, in a
  CloseGreens close(setup_.surface, loaded_, kWidest * setup_.patch_radius);
  const Blocks& blocks = greens.blocks();
  Progress progress("nodal Green's functions", blocks.ownEnd() - blocks.ownBegin(), options_.quiet);
  std::vector<std::unique_ptr<NodalGreens>> solvers(index(options_.workers));
  const auto sourcesOf = [&](std::size_t chunk) {
    const std::size_t first = chunk * NodalGreens::kMost;
    return blocks.order().subspan(first, std::min(NodalGreens::kMost, blocks.order().size() - first));
  };
  const auto restore = [&](std::size_t chunk, record::ByteSource& kept) {
    std::vector<float> fields;
    for (const std::int32_t source : sourcesOf(chunk)) {
      if (kept.get<std::uint32_t>() != greens.checksum(index(source), fields))
        throw record::RecordError("the scratch file has other fields");
      close.keep(index(source),
                 Eigen::Map<const Eigen::MatrixXf>(fields.data(), Eigen::Index(greens.rows()), 3));
    }
    progress.skip(sourcesOf(chunk).size());
  };
  const auto solve = [&](int worker, std::size_t chunk) {
    auto& solver = solvers[index(worker)];
    if (!solver) solver = std::make_unique<NodalGreens>(setup_.model, factor_, setup_.surface);
    const auto sources = sourcesOf(chunk);
    std::vector<std::int32_t> nodes;
    for (const std::int32_t source : sources) nodes.push_back(loaded_[index(source)]);
    solver->solve(nodes);
    record::Bytes kept;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const Eigen::MatrixXf W = solver->of(i).cast<float>();
      const std::span<const float> fields(W.data(), static_cast<std::size_t>(W.size()));
      close.keep(index(sources[i]), W);
      greens.write(index(sources[i]), fields);
      record::put(kept, FieldTable::checksum(fields));
    }
    progress.advance(sources.size());
    return kept;
  };
  parallelParts(options_.workers, partsOf(blocks, NodalGreens::kMost), options_.journal("greens"), restore,
                solve);
  share(blocks, [&](std::int32_t source) { return close.of(index(source)); });
  data_.contact_stiffness = patchStiffness(setup_, patches_, close, options_.workers, *options_.ranks);
}

modelfile::ModelData DisplacementBuilder::run() {
  const Stopwatch series_watch;
  const std::size_t rows = 3 * setup_.surface.nodes.size();
  const Ranks& ranks = *options_.ranks;
  FieldTable table(options_.scratchFile("series"), blocksOf(setup_, setup_.positions.nodes, kLanes, ranks),
                   index(basis_.size()), rows);
  solveAllSeries(setup_, mesh_, case_, factor_, SeriesKind::kDisplacement, options_, table, seriesSink());
  FieldTable greens(options_.scratchFile("greens"), blocksOf(setup_, loaded_, NodalGreens::kMost, ranks), 3,
                    rows);
  solveGreens(greens);
  storeOrgan(setup_, mesh_, data_);
  ModelAttributes& a = data_.attributes;
  storeAttributes(case_, setup_, a);
  a.order = basis_.order();
  a.force_order = force_basis_.order();
  a.reference_displacement = d_ref_;
  std::unique_ptr<FieldTable> shared;
  if (case_.handheld()) shared = shareLoads(greens);
  report_.series_seconds = series_watch.seconds();

  const Stopwatch fit_watch;
  if (case_.handheld()) makeCompact();
  fit(table, shared ? *shared : greens);  // by each position's own radius
  a.near_radius = near_radius_;
  report_.fit_seconds = fit_watch.seconds();
  if (case_.handheld()) return std::move(data_);  // edges are for fields that are more exact
  const Stopwatch edge_watch;
  report_.edges = storeEdgeFields(
      setup_, factor_, patches_, basis_.order(),
      {case_.travelOrDefault(), case_.fieldErrorOrDefault(), case_.forceErrorOrDefault()}, options_, data_);
  report_.series_seconds += edge_watch.seconds();
  return std::move(data_);
}

ChosenOrgan::ChosenOrgan(const Case& c, const mesh::TetMesh& organ, const BuildOptions& options,
                         BuildReport& report)
    : mesh(c.handheld() ? inFloats(organ) : organ), setup(c, mesh), factor(setup.model), chosen(c) {
  const Stopwatch factor_watch;
  factorizeAtRest(factor, setup, mesh, c);
  report.factor_seconds = factor_watch.seconds();
  if (c.mesh_error) {
    const Stopwatch mesh_watch;
    report.mesh_error = keptOr<MeshError>(
        options.journal("mesh-error"), 0, [&] { return meshError(setup, mesh, factor, options.workers); },
        [](record::Bytes& out, const MeshError& error) {
          putArray(out, std::vector<double>{error.mean, error.largest, double(error.points),
                                            double(error.raised)});
        },
        [](record::ByteSource& in, MeshError& error) {
          const std::vector<double> kept = numbersOf<double>(in, 4);
          error = {kept[0], kept[1], static_cast<int>(kept[2]), kept[3] != 0.0};
        });
    report.mesh_error_seconds = mesh_watch.seconds();
  }
  if (!c.ordersByTravel() && !c.handheld()) return;
  const Stopwatch orders_watch;
  report.travel = keptOr<TravelOrders>(
      options.journal("orders"), 0,
      [&] { return ordersFor(c.travelOrDefault(), criteriaOf(c), setup, factor, options, triedOrders(c)); },
      putOrders, getOrders);
  chosen.order = report.travel->orders.fields;
  chosen.force_order = report.travel->orders.answer;
  report.orders_seconds = orders_watch.seconds();
}

modelfile::ModelData buildDisplacementSeries(const Case& c, const mesh::TetMesh& organ,
                                             const BuildOptions& options, BuildReport& report) {
  const SerialBlas serial;
  const ChosenOrgan chosen(c, organ, options, report);
  DisplacementBuilder builder(chosen, options, report);
  requireRoom(builder.sizes(), chosen.chosen, options, options.output);
  (void)options.ranks->all(true);  // none takes room before the last one has looked
  return builder.run();
}

}  // namespace palpate::solver
