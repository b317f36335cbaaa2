// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "tools/modelfile/write_model.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/build/build_model_parts.h"
#include "tools/solver/build/displacement_builder.h"
#include "tools/solver/build/displacement_fields.h"
#include "tools/solver/build/edge_fields.h"
#include "tools/solver/build/estimate.h"
#include "tools/solver/build/shared_loads.h"
#include "tools/solver/fit/far_field_fit.h"
#include "tools/solver/series/nodal_greens.h"

namespace palpate::solver {

namespace {

double peakBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Bytes that are resident now.
double residentBytes() {
  double all = 0.0, resident = 0.0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double total(std::span<const NearNodes> near) {
  return std::accumulate(near.begin(), near.end(), 0.0, [](double sum, const NearNodes& one) {
    return sum + static_cast<double>(one.nodes.size());
  });
}

/// Wall-clock time of each piece of work, with every worker at it: two rounds, of which the second counts.
template <typename Work>
double secondsEach(int workers, const Work& work) {
  constexpr int kRounds = 2;
  double seconds = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const Stopwatch watch;
    parallelFor(workers, static_cast<std::size_t>(workers), [&](int worker, std::size_t piece) {
      work(worker, static_cast<std::size_t>(round * workers) + piece);
    });
    seconds = watch.seconds() / workers;
  }
  return seconds;
}

/// Multiplications and additions per second of all workers, in products of the shape that the fit has most of.
double productRate(int workers) {
  constexpr Eigen::Index kRows = 16384, kInner = 256, kColumns = 128;
  std::vector<std::array<Eigen::MatrixXf, 3>> own(static_cast<std::size_t>(workers));
  for (auto& m : own)
    m = {Eigen::MatrixXf::Random(kRows, kInner), Eigen::MatrixXf::Random(kInner, kColumns),
         Eigen::MatrixXf::Zero(kRows, kColumns)};
  const double each = secondsEach(workers, [&](int worker, std::size_t) {
    auto& [A, B, C] = own[static_cast<std::size_t>(worker)];
    C.noalias() += A * B;
  });
  return 2.0 * static_cast<double>(kRows * kInner * kColumns) / each;
}

/// What the fit has to do with.
struct FitCounts {
  double surface_nodes, positions, loads, coefficients;
  double positions_seen, loads_seen;  ///< part of all nodes whose weights a block of positions or loads has
  double nodes_seen;                  ///< part of all positions whose weights a block of nodes has
};

/// Seconds of the fit: a head start on a part of the positions, sweeps over all, and the loads. Weights and the constant are
/// those of organs of 2400 to 3700 surface nodes (docs/scale.md).
/// @param rate  productRate()
double fitSeconds(const FitCounts& c, double n, bool given, int sweeps, double rate) {
  constexpr double kSlower = 2.0;   // the small factorizations
  constexpr double kBesides = 1.9;  // of all work, over what is counted here
  const double grams = n * n * c.surface_nodes, solving = kSlower * n * n * n;
  const auto y = [&](double sources, double seen, double columns) {
    return sources * (seen * grams + 6.0 * n * c.surface_nodes * columns + solving);
  };
  const double principal = std::min(c.coefficients, static_cast<double>(FarFieldFit::kPrincipal));
  const double x = c.positions * (c.nodes_seen * grams + 6.0 * n * c.surface_nodes * principal) +
                   c.surface_nodes * solving;
  const double sweep = y(c.positions, c.positions_seen, principal) + x;
  const double head = given ? 0.8 : 1.5, constant = given ? 1.0 : 3.0;  // sweeps; s
  const double last = y(c.positions, c.positions_seen, c.coefficients);
  return constant + kBesides * ((sweeps + head) * sweep + last + y(c.loads, c.loads_seen, 3.0)) / rate;
}

/// Seconds of SharedLoads and their fields: the solution, by doubles, and the sums of fields.
double sharedSeconds(double loaded, double sources, double rows, double rate) {
  constexpr double kDoubles = 2.0;  // times as long
  return (kDoubles * 2.0 * sources * sources * loaded + 6.0 * rows * loaded * sources) / rate;
}

/// Part of all nodes that are closer to a block of others than three near radii, where weights differ from the area's.
/// @param others  blocks lie around them  @param block  how many of them
double partSeen(const PatchSurface& surface, std::span<const std::int32_t> others, std::size_t block,
                double near_radius) {
  constexpr std::size_t kSeenFrom = 64;
  const double area = std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0);
  const double part = static_cast<double>(block) / static_cast<double>(std::max(block, others.size()));
  const double reach = 3.0 * near_radius + std::sqrt(part * area / std::numbers::pi);
  double pairs = 0.0, seen = 0.0;
  for (std::size_t i = 0; i < others.size(); i += std::max<std::size_t>(1, others.size() / kSeenFrom))
    for (const Vec3& X : surface.positions) {
      ++pairs;
      seen += (X - surface.positions[static_cast<std::size_t>(others[i])]).norm() < reach ? 1.0 : 0.0;
    }
  return seen / pairs;
}

/// About as many modes as an error wants: with the square root of the surface over that of a near field, and e^(-2/3).
double modesFor(double error, const PatchSurface& surface, double near_radius) {
  constexpr double kAtOnePercent = 30.0, kMost = 400.0;
  const double area = std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0);
  return std::clamp(kAtOnePercent * std::sqrt(area) / near_radius * std::pow(0.01 / error, 2.0 / 3.0), 30.0,
                    kMost);
}

}  // namespace

/// Bytes, and the number of modes; memory without what the series takes.
Estimate DisplacementBuilder::sizes() const {
  constexpr double kKept = 0.9;  // of the nodes of near fields, what is not left out as too small
  const double nodes = static_cast<double>(setup_.surface.nodes.size()), rows = 3.0 * nodes;
  const std::vector<std::int32_t> sources = sourcesOfLoads();
  const double M = static_cast<double>(setup_.positions.nodes.size()),
               G = static_cast<double>(sources.size());
  const double C = basis_.size(), Cm = C - 3.0;
  Estimate out;
  const auto own = [&](std::size_t entries, std::size_t part) {  // of this rank
    const Blocks blocks(entries, *options_.ranks, part);
    return static_cast<double>(blocks.ownEnd() - blocks.ownBegin());
  };
  constexpr double principal{FarFieldFit::kPrincipal};
  const bool shares = sources.size() < loaded_.size();
  out.scratch =
      4.0 * rows *
      (own(setup_.positions.nodes.size(), kLanes) * (C > principal ? C + principal : C) +
       3.0 * own(loaded_.size(), NodalGreens::kMost) + (shares ? 3.0 * own(sources.size(), 1) : 0.0));
  double n = case_.modes ? *case_.modes : modesFor(case_.fieldErrorOrDefault(), setup_.surface, near_radius_);
  if (case_.handheld() && !case_.modes)
    n = std::clamp(0.45 * case_.sizeLimitOrDefault() / (rows + 3.0 * G + M * Cm / 3.0), 12.0, 400.0);
  out.modes = static_cast<int>(std::lround(n));

  // 1. The file: fields as whole numbers of two bytes, with a node's number for each node of a near field; all else as doubles. A
  // small file has half of that, and few modes for what positions have of them.
  modelfile::ModelData organ;
  organ.attributes.order = basis_.order();
  organ.attributes.force_order = force_basis_.order();
  organ.compact = case_.handheld();
  storeOrgan(setup_, mesh_, organ);
  const EdgeCounts edges = case_.handheld() ? EdgeCounts{} : edgeCounts(setup_, basis_.order());
  const double near = kKept * total(near_), near_loads = total(shares ? nearOf(sources) : near_loaded_);
  const double near_edges = kKept * static_cast<double>(edges.solved) * edges.nodes, Ce = edges.coefficients;
  const double whole = case_.handheld() ? 1.0 : 2.0, real = 4.0 * whole;   // bytes
  const double number = case_.handheld() && nodes <= 32767.0 ? 2.0 : 4.0;  // of a node
  const double of_positions =
      case_.handheld() ? static_cast<double>(SizeBudget::positionModes(out.modes)) : n;
  out.file = static_cast<double>(modelfile::storedBytes(organ)) + 3.0 * real * M * force_basis_.size() +
             24.0 * real * (M + static_cast<double>(edges.all)) + n * (whole * rows + 4.0) +
             M * Cm * (whole * of_positions + 8.0) + 3.0 * G * (whole * n + 8.0) +
             near * (3.0 * whole * Cm + number) + near_loads * (9.0 * whole + number) +
             near_edges * (3.0 * whole * Ce + 4.0) + 4.0 * Ce * static_cast<double>(edges.all);
  if (case_.handheld()) out.file = std::min(out.file, case_.sizeLimitOrDefault());

  // 2. Memory: the fit, or what the model is put together from.
  const double floats = 4.0 * (near * 3.0 * Cm + 9.0 * near_loads + 3.0 * Ce * near_edges +
                               of_positions * M * Cm + n * (rows + 3.0 * G));
  const double work =
      options_.workers * (2.0 * 4.0 * 32.0 * C * rows + 8.0 * n * rows + 4.0 * 256.0 * 0.5 * n * n);
  constexpr double kAtOnce{FarFieldFit::kNodes};  // whose matrices a worker adds up
  const double sums = 2.0 * n * n * options_.workers * kAtOnce;
  constexpr double kLibraries = 3e7;  // OpenBLAS, HDF5, stacks
  const double fit =
      4.0 * nodes * std::max(M, G) + (8.0 * n + 4.0 * principal) * M * C + 32.0 * n * rows + work + sums;
  out.resident = residentBytes();
  // The loads with their Gram matrix, or with what superpose() sums at once and 64 fields.
  const double L = static_cast<double>(loaded_.size()), all_loads = 4.0 * L * G;
  const double sharing =
      shares
          ? all_loads + std::max(8.0 * G * G,
                                 std::min(static_cast<double>(kSummedAtOnce), 12.0 * rows * G) + 768.0 * rows)
          : 0.0;
  out.memory = kLibraries + out.resident + std::max({fit + 0.25 * floats, 2.0 * floats, sharing});
  return out;
}

/// Of a chunk of positions, s. @param radii  whether their domains count
double DisplacementBuilder::probeSeries(const SeriesOrders& orders, bool radii) const {
  const std::vector<Patch>& all = setup_.positions.patches;
  const std::size_t count = std::min<std::size_t>(kLanes, all.size());
  std::vector<std::unique_ptr<SeriesSolver>> solvers;
  for (int w = 0; w < options_.workers; ++w)
    solvers.push_back(std::make_unique<SeriesSolver>(setup_.model, factor_, orders));
  std::vector<std::vector<float>> fields(solvers.size());
  return secondsEach(options_.workers, [&](int worker, std::size_t piece) {
    const auto patches = std::span(all).subspan(piece * kLanes % (all.size() - count + 1), count);
    SeriesSolver& solver = *solvers[static_cast<std::size_t>(worker)];
    solver.solve(patches);
    if (radii) (void)solver.domainRadii(criteriaOf(case_));
    std::vector<float>& own = fields[static_cast<std::size_t>(worker)];
    own.resize(count * static_cast<std::size_t>(solver.basis().size()) * 3 * setup_.surface.nodes.size());
    solver.copyDisplacements(setup_.surface.nodes, own);
  });
}

/// Of a chunk of loads, s.
double DisplacementBuilder::probeGreens() const {
  const std::size_t count = std::min(loaded_.size(), NodalGreens::kMost);
  std::vector<std::unique_ptr<NodalGreens>> solvers;
  for (int w = 0; w < options_.workers; ++w)
    solvers.push_back(std::make_unique<NodalGreens>(setup_.model, factor_, setup_.surface));
  return secondsEach(options_.workers, [&](int worker, std::size_t piece) {
    NodalGreens& solver = *solvers[static_cast<std::size_t>(worker)];
    solver.solve(std::span(loaded_).subspan(piece * count % (loaded_.size() - count + 1), count));
    for (std::size_t i = 0; i < count; ++i) (void)solver.of(i);
  });
}

/// A few positions, loads and edges are solved on all workers; the fit is counted in products.
Estimate DisplacementBuilder::estimate() const {
  const Stopwatch watch;
  Estimate out = sizes();
  const std::vector<std::int32_t> sources = sourcesOfLoads();
  const double M = static_cast<double>(setup_.positions.nodes.size()),
               G = static_cast<double>(loaded_.size()), S = static_cast<double>(sources.size());
  const auto rounds = [&](double all, double chunk) {  // of all workers
    return options_.workers * std::ceil(std::ceil(all / chunk) / options_.workers);
  };
  out.series = probeSeries(case_.orders(), true) * rounds(M, kLanes) +
               probeGreens() * rounds(G, static_cast<double>(NodalGreens::kMost));
  const EdgeCounts edges = case_.handheld() ? EdgeCounts{} : edgeCounts(setup_, basis_.order());
  if (edges.solved > 0)
    out.edges =
        probeSeries({edges.degree, edges.degree}, false) * rounds(static_cast<double>(edges.solved), kLanes);
  out.memory = std::max(out.memory, peakBytes());
  std::vector<std::int32_t> nodes(setup_.surface.positions.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  const FitCounts counts{static_cast<double>(setup_.surface.nodes.size()),
                         M,
                         S,
                         static_cast<double>(basis_.size()),
                         partSeen(setup_.surface, setup_.positions.nodes, Blocks::kMost, near_radius_),
                         partSeen(setup_.surface, sources, Blocks::kMost, near_radius_),
                         partSeen(setup_.surface, nodes, FarFieldFit::kNodes, near_radius_)};
  const double rate = productRate(options_.workers);
  out.fit = fitSeconds(counts, out.modes, case_.modes.has_value(), case_.sweepsOrDefault(), rate);
  if (S < G) out.series += sharedSeconds(G, S, 3.0 * counts.surface_nodes, rate);
  constexpr double kWritten = 1e8;  // bytes a second
  out.write = out.file / kWritten;
  out.probe = watch.seconds();
  return out;
}

Estimate estimateDisplacementSeries(const Case& c, const mesh::TetMesh& organ, const BuildOptions& options,
                                    BuildReport& report) {
  const SerialBlas serial;
  const ChosenOrgan chosen(c, organ, options, report);
  Estimate out = DisplacementBuilder(chosen, options, report).estimate();
  out.factor = report.factor_seconds;
  out.mesh_error = report.mesh_error_seconds;
  out.orders = report.orders_seconds;
  return out;
}

}  // namespace palpate::solver
