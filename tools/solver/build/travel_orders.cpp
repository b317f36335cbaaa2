// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/travel_orders.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "tools/modelfile/reach.h"
#include "tools/solver/base/lanes.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {

namespace {

constexpr double kWorth = 0.01;  // of all touches: what a higher order has to add

/// Patches of accessible positions, spread over their list.
std::vector<Patch> somePatches(const ContactPositions& positions) {
  constexpr std::size_t kMost = 16;
  std::vector<std::size_t> accessible;
  for (std::size_t p = 0; p < positions.nodes.size(); ++p)
    if (positions.accessible[p] != 0) accessible.push_back(p);
  const std::size_t count = std::min(kMost, accessible.size());
  std::vector<Patch> some;
  for (std::size_t i = 0; i < count; ++i)
    some.push_back(positions.patches[accessible[(2 * i + 1) * accessible.size() / (2 * count)]]);
  return some;
}

/// d_max of each patch. @param travel  m
std::vector<double> radiiOf(const SeriesOrders& orders, const DomainCriteria& criteria,
                            const std::vector<Patch>& patches, const SolverSetup& setup,
                            const Cholesky& factor, int workers) {
  std::vector<double> domain(patches.size());
  parallelFor(workers, (patches.size() + kLanes - 1) / kLanes, [&](int, std::size_t chunk) {
    SeriesSolver series(setup.model, factor, orders);
    const std::size_t first = chunk * kLanes;
    series.solve(std::span(patches).subspan(first, std::min<std::size_t>(kLanes, patches.size() - first)));
    const std::vector<SeriesRadii> radii = series.domainRadii(criteria);
    for (std::size_t lane = 0; lane < radii.size(); ++lane) domain[first + lane] = radii[lane].domain;
  });
  return domain;
}

}  // namespace

TravelOrders ordersFor(double travel, const DomainCriteria& criteria, const SolverSetup& setup,
                       const Cholesky& factor, const BuildOptions& options,
                       std::span<const SeriesOrders> tried) {
  const std::vector<Patch> patches = somePatches(setup.positions);
  Progress progress("orders that reach the travel", tried.size(), options.quiet);
  TravelOrders best{travel, tried.front(), 0, static_cast<int>(patches.size()), -1.0};
  std::vector<TriedOrders> list;
  for (const SeriesOrders& orders : tried) {
    TravelOrders now{travel, orders, 0, best.places, 0.0};
    for (const double radius : radiiOf(orders, criteria, patches, setup, factor, options.workers)) {
      now.reaching += radius >= travel ? 1 : 0;
      now.within += modelfile::touchWithin(radius, travel) / best.places;
    }
    progress.advance();
    list.push_back({orders, now.within});
    if (now.within >= kEnoughTouches || now.within > best.within + kWorth) best = now;
    if (best.within >= kEnoughTouches) break;
  }
  best.tried = std::move(list);
  return best;
}

}  // namespace palpate::solver
