// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/travel_orders.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "tools/solver/base/lanes.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {

namespace {

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

int reaching(double travel, const SeriesOrders& orders, const std::vector<Patch>& patches,
             const SolverSetup& setup, const Cholesky& factor, int workers) {
  std::vector<int> counts((patches.size() + kLanes - 1) / kLanes, 0);
  parallelFor(workers, counts.size(), [&](int, std::size_t chunk) {
    SeriesSolver series(setup.model, factor, orders);
    const std::size_t first = chunk * kLanes;
    series.solve(std::span(patches).subspan(first, std::min<std::size_t>(kLanes, patches.size() - first)));
    for (const SeriesRadii& radii : series.domainRadii({})) counts[chunk] += radii.domain >= travel ? 1 : 0;
  });
  int all = 0;
  for (const int count : counts) all += count;
  return all;
}

}  // namespace

TravelOrders ordersFor(double travel, const SolverSetup& setup, const Cholesky& factor,
                       const BuildOptions& options, std::span<const SeriesOrders> tried) {
  const std::vector<Patch> patches = somePatches(setup.positions);
  Progress progress("orders that reach the travel", tried.size(), options.quiet);
  TravelOrders best{travel, tried.front(), -1, static_cast<int>(patches.size())};
  for (const SeriesOrders& orders : tried) {
    const int count = reaching(travel, orders, patches, setup, factor, options.workers);
    progress.advance();
    if (count > best.reaching) {
      best.orders = orders;
      best.reaching = count;
    }
    if (2 * count >= best.places) break;
  }
  return best;
}

}  // namespace palpate::solver
