// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/base/multi_index.h"
#include "tools/solver/fit/field_table.h"
#include "tools/solver/fit/near_field.h"

namespace palpate::solver {

/// Input of the fit. The table holds U_alpha unscaled, rows node-interleaved.
struct FitProblem {
  const FieldTable& table;
  const MonomialBasis& basis;
  std::span<const double> areas;        ///< Ns, m^2
  std::span<const FitWeights> weights;  ///< M
  std::span<const double> ball_radius;  ///< M, m (N): the mean is over this ball
  double reference;                     ///< d_ref, m (f_ref, N): polynomials are in d / d_ref
  /// M, m: displacement that the errors of each position are relative to; empty: d_ref for all
  std::span<const double> size{};
};

struct FitOptions {
  int modes{120};  ///< n, >= 1
  int sweeps{6};   ///< alternating-direction sweeps
  int workers{1};
  bool quiet{false};
};

/// u_far(X; s, d) = sum_k X_k(X) sum_alpha (d / d_ref)^alpha Y_k,alpha(s)               docs/design.md, Parts
struct FarField {
  Eigen::MatrixXf X;  ///< 3 Ns x n, node-interleaved; orthonormal in the area-weighted product; by energy
  Eigen::MatrixXf Y;  ///< n x (M C), column position * C + k, m
  std::vector<double> errors;  ///< after each sweep: RMS of the error over RMS of the field, in the weights
};

}  // namespace palpate::solver
