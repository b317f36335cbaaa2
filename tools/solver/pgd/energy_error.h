// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tools/solver/pgd/parametric_problem.h"
#include "tools/solver/pgd/separated_solution.h"

namespace palpate::solver {

// For evaluation only: these functions solve at every load position, block by block. The PGD never does.

/// sum_s w_s |u_s - v_s|^2 over sum_s w_s |u_s|^2 in the energy norm, its root; u_s the full solutions of the
/// linear problem, v_s = X Y(s). @throw std::invalid_argument when sizes do not fit
[[nodiscard]] double energyError(const ParametricProblem& problem, const ScalarPairs& pairs, int workers);

/// C_st = l_s^T K^-1 l_t, M x M, m N.
[[nodiscard]] Eigen::MatrixXd complianceMatrix(const ParametricProblem& problem, int workers);

/// Singular values of u(x, s) in the energy norm and the weights, falling: roots of the eigenvalues of
/// W^1/2 C W^1/2. Good to 1e-8 of the first. Cost O(M^3): seconds for M = 2000.
[[nodiscard]] Eigen::VectorXd energySingularValues(const Eigen::MatrixXd& compliance,
                                                   const Eigen::VectorXd& weights);

/// Smallest energy error that n pairs can reach: sqrt(sum_{k>n} sigma_k^2 / sum_k sigma_k^2).
[[nodiscard]] double bestError(const Eigen::VectorXd& singular_values, Eigen::Index n);

}  // namespace palpate::solver
