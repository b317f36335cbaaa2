// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/multi_index.h"
#include "tools/solver/base/cauchy_product.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/series/node_order.h"
#include "tools/solver/series/series_kernel.h"

namespace palpate::solver {

/// W[k] += length^|gamma| W_gamma of the body's springs, J: k/2 sum U_b . U_c. In double; few nodes have springs.
/// @param basis  of the fields  @param rows  pairs that make up the coefficients of W, as for energyCoefficients
void addSpringEnergies(const FeModel& model, const NodeOrder& order, const MonomialBasis& basis,
                       const KernelInput& input, const CauchyRows& rows, Lanes* W);

}  // namespace palpate::solver
