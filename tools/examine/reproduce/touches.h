// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/contact_point.h"
#include "core/model/meta_model.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/cholesky.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/fem/patch.h"

namespace palpate::reproduce {

/// A load at a point that no model was made from, and its full Newton solution.
struct Touch {
  ContactPoint s;
  solver::Patch patch;               ///< centred at s itself
  Vec3 force = Vec3::Zero();         ///< f, N
  Vec3 displacement = Vec3::Zero();  ///< patch-averaged, Newton, m
  Eigen::VectorXd surface;           ///< Newton's u of the surface nodes, 3 Ns, m
};

/// Errors of a model relative to the contact displacement (field, contact) or to the force.
struct TouchError {
  double field{0.0};    ///< largest |u - u_Newton| over the surface nodes / |d_Newton|, f prescribed
  double contact{0.0};  ///< |d - d_Newton| / |d_Newton|, f prescribed
  double force{0.0};    ///< |f - f_Newton| / |f_Newton|, d_Newton prescribed
};

/// Points off the nodes, evenly over the area of the triangles whose nodes are all contact positions.
[[nodiscard]] std::vector<Touch> drawPoints(const solver::SolverSetup& setup, int count, unsigned seed);

/// Loads of random directions whose linear contact displacement is evenly up to `travel`.
void drawLoads(const solver::FeModel& model, const solver::Cholesky& K0, double travel, unsigned seed,
               std::vector<Touch>& touches);
/// Scales each load down to the domain of a "force" model at its point. @return number of scaled loads
int limitLoads(const MetaModel& model, std::vector<Touch>& touches);

/// Full Newton for every touch, on `workers` threads. @throw std::runtime_error when it does not converge
void solveTouches(const solver::SolverSetup& setup, int workers, bool quiet, std::vector<Touch>& touches);

/// @param model  of any kind, on the same surface. @throw std::runtime_error at a point without an answer
[[nodiscard]] std::vector<TouchError> errorsOf(const MetaModel& model, const std::vector<Touch>& touches);

/// The q-quantile of one member, nearest rank.
[[nodiscard]] double quantile(const std::vector<TouchError>& errors, double TouchError::*member, double q);

}  // namespace palpate::reproduce
