// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/base/multi_index.h"

namespace palpate::solver {

/// Lower triangular L with L L^T = M, M_kl the mean of x^(alpha_k + alpha_l) over the unit ball |x| <= 1:
/// coefficients times L have a squared norm equal to the mean square of their polynomial.
[[nodiscard]] Eigen::MatrixXd momentFactor(const MonomialBasis& basis);

}  // namespace palpate::solver
