// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "tools/solver/fem/cholesky.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/fem/patch.h"

namespace palpate::solver {

/// Newton's method does not converge. what() has the load fraction at which no step does.
class NoConvergence : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Steps and tolerances of the full solver.
struct NewtonOptions {
  int steps{1};             ///< equal load steps to begin with, >= 1; a step that fails is halved
  int max_iterations{30};   ///< per step
  int max_halvings{10};     ///< in a row
  int extra_steps{100};     ///< tried after `steps` before the solver gives up, failed ones included
  double tolerance{1e-10};  ///< of the residual, relative to the largest internal nodal force
  double held{
      0.0};  ///< a factor serves on while iterations leave less than this part of the residual; 0: one each
  /// Three iterations that leave a larger residual end a step: where a tangent is not positive definite, each takes long.
  double lost{std::numeric_limits<double>::infinity()};
};

struct NewtonResult {
  Eigen::VectorXd u;         ///< displacement, 3 N, m
  Vec3 force{Vec3::Zero()};  ///< force of the (first) tool on the organ, N (patch problems)
  std::vector<Vec3> forces;  ///< of every tool, N (patch problems)
  double residual{0.0};      ///< at the end, relative like the tolerance
  int iterations{0};         ///< over all steps
};

/// What one tool imposes: G_s^T u = d.
struct ImposedPatch {
  Patch patch;            ///< G_s: weights of the contact patch at s
  Vec3 d = Vec3::Zero();  ///< patch-averaged displacement, m
};

/// Full Newton with consistent tangent: the reference for every model.   docs/design.md, Reproduction, Series
/// Steps that do not converge are halved. Not real-time; one object per thread.
class NewtonSolver {
 public:
  explicit NewtonSolver(const FeModel& model) : model_(model), factor_(model) {}

  /// f_int(u) = load on the free nodes. @param load  3 N, N (dead load)
  /// @throw NoConvergence with the load fraction at which no step converges
  [[nodiscard]] NewtonResult solveLoad(const Eigen::VectorXd& load, const NewtonOptions& options);

  /// f_int(u) = G_s f, G_s^T u = d: the displacement-driven problem of docs/design.md, Series.
  /// @param patch  weights of the contact patch at s  @param d  patch-averaged displacement, m
  /// @throw NoConvergence with the fraction of d at which no step converges
  [[nodiscard]] NewtonResult solvePatch(const Patch& patch, const Vec3& d, const NewtonOptions& options);
  /// Several tools at once: f_int(u) = sum_A G_A f_A, G_A^T u = d_A for every A, all d growing together.
  /// @param tools  at least one; two patches on the same single node have no solution
  /// @throw NoConvergence with the fraction of the d at which no step converges
  [[nodiscard]] NewtonResult solvePatches(std::span<const ImposedPatch> tools, const NewtonOptions& options);
  /// The same from a state near the solution, the d at once. @param start  3 N, m
  /// @return nothing where it does not converge from there
  [[nodiscard]] std::optional<NewtonResult> solvePatchesFrom(const Eigen::VectorXd& start,
                                                             std::span<const ImposedPatch> tools,
                                                             const NewtonOptions& options);

 private:
  template <typename Problem>
  NewtonResult walk(Problem problem, const NewtonOptions& options);

  const FeModel& model_;
  Cholesky factor_;
};

}  // namespace palpate::solver
