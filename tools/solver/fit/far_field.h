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

/// Weighted alternating directions: least squares in X and Y in turn, of the error that remains after the
/// near field. The weight of node i for position s is A_i (1 - window(r_is))^2 g(r_is); d is uniform in the
/// ball of each position and the error relative to |d|. Entries under a window of 1 are free.
/// Source: docs/design.md, Parts; g and the mean over the ball are ours. Reads the table once per sweep.
/// @throw std::runtime_error on a bad table
[[nodiscard]] FarField fitFarField(const FitProblem& problem, const FitOptions& options);

}  // namespace palpate::solver
