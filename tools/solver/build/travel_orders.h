// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/solver/build/build_options.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/cholesky.h"

namespace palpate::solver {

/// The least orders of fields and force with which half of 16 places reach a travel; where none are enough, those with which
/// most do. A place reaches it when d_max of the contact position itself is at least that.    docs/decisions/travel.md
/// @param factor  of K_T(0)  @param travel  m. Seconds to a minute.
[[nodiscard]] TravelOrders ordersFor(double travel, const SolverSetup& setup, const Cholesky& factor,
                                     const BuildOptions& options);

}  // namespace palpate::solver
