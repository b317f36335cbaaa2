// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/solver/fit/fit_problem.h"

namespace palpate::solver {

/// Weighted alternating directions: least squares in X and Y in turn, of the error that remains after the
/// near field. The weight of node i for position s is A_i (1 - window(r_is))^2 g(r_is); d is uniform in the
/// ball of each position and the error relative to |d|. Entries under a window of 1 are free.
/// Source: docs/design.md, Parts; g and the mean over the ball are ours. Reads the table once per sweep.
/// @throw std::runtime_error on a bad table
[[nodiscard]] FarField fitFarField(const FitProblem& problem, const FitOptions& options);

/// The Y-step alone: amplitudes of given modes for other sources, by the same weights.
/// @param problem  with sources and columns of its own  @param X  FarField::X  @return n x (sources C), as FarField::Y
/// @throw std::runtime_error on a bad table
[[nodiscard]] Eigen::MatrixXf amplitudesOf(const FitProblem& problem, const Eigen::MatrixXf& X, int workers);

}  // namespace palpate::solver
