// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tools/solver/fem/fe_model.h"

namespace palpate::solver {

/// (sum det F V) / (sum V) - 1: relative change of the body's volume. Linear solutions of large bending gain
/// volume without a physical cause.
///                                                                                   paper Sections 3 and 4.2
/// @param u  3 N, m
[[nodiscard]] double volumeChange(const FeModel& model, const Eigen::VectorXd& u);

/// (int |u|^2 dX)^(1/2) of a nodal field, exact for linear tetrahedra, m^(5/2). @param u  3 N, m
[[nodiscard]] double normL2(const FeModel& model, const Eigen::VectorXd& u);

/// |u - reference| / |reference| in L2. @throw std::invalid_argument when the reference is zero
[[nodiscard]] double relativeErrorL2(const FeModel& model, const Eigen::VectorXd& u,
                                     const Eigen::VectorXd& reference);

}  // namespace palpate::solver
