// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/fit/far_field.h"
#include "tools/solver/fit/near_field.h"

namespace palpate::solver {

/// /green of a model: amplitudes of the modes by unit loads at nodes, and window (W_i - what the modes give) near node i.
///                                                                                       docs/design.md, Parts
/// @param greens  W_i, m/N  @param X  the modes  @param near  nodes of each source
/// @throw std::runtime_error on a bad table
void storeGreens(const FitProblem& greens, const Eigen::MatrixXf& X, std::span<const NearNodes> near,
                 int workers, modelfile::ModelData& data);

/// What near fields leave out that is not seen: a part of the travel at a node.
inline constexpr double kUnseen = 2e-4;

/// /modes/Y and /near of a model, of orders of two and more: amplitudes of the modes, and window (U_alpha - what the modes
/// give) at the nodes near each position where that is more than a small part of the travel.   docs/design.md, Parts
/// @param near  nodes of each source
/// @return by node of the near fields, how far it is moved over abs(d) at most, in 26 directions, abs(d) the ball's radius
std::vector<float> storeNearField(const FitProblem& problem, const FarField& far,
                                  std::span<const NearNodes> near, int workers, modelfile::ModelData& data);

}  // namespace palpate::solver
