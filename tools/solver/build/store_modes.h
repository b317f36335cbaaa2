// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tools/modelfile/model_data.h"
#include "tools/solver/build/solver_setup.h"

namespace palpate::solver {

/// Modes, an empty near field, and the contact displacement d_alpha(s) = G_s^T sum_k X_k Y_k,alpha(s): the
/// displacement of the modes, so that the field on screen and the contact agree.
///                                                                               docs/design.md, Reproduction
/// @param X  3 Ns x n  @param Y  n x (M C), column position * C + alpha, m
void storeModes(const SolverSetup& setup, const Eigen::MatrixXf& X, const Eigen::MatrixXf& Y,
                modelfile::ModelData& data);

}  // namespace palpate::solver
