// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "tools/solver/build/build_options.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/cholesky.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {

/// The orders that a travel chooses from, by cost.
inline constexpr std::array<SeriesOrders, 5> kTravelOrders{{{3, 6}, {4, 6}, {5, 6}, {5, 8}, {6, 8}}};

/// The least orders of fields and force with which kEnoughTouches of all touches are within d_max of the position itself, in the
/// mean of 16 places; where none are enough, those with which most are, if they add 1 % of all touches to cheaper ones.                 docs/decisions/travel.md
/// @param factor  of K_T(0)  @param travel  m  @param tried  by cost. Seconds to a minute.
[[nodiscard]] TravelOrders ordersFor(double travel, const DomainCriteria& criteria, const SolverSetup& setup,
                                     const Cholesky& factor, const BuildOptions& options,
                                     std::span<const SeriesOrders> tried = kTravelOrders);

inline constexpr double kEnoughTouches = 0.9;

}  // namespace palpate::solver
