// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/newton.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace palpate::solver {

namespace {

Eigen::VectorXd toDofs(const FeModel& model, const Eigen::VectorXd& nodal) {
  Eigen::VectorXd b(model.dofCount());
  for (int node = 0; node < model.nodeCount(); ++node)
    if (model.isFree(node)) b.segment<3>(model.dof(node)) = nodal.segment<3>(3 * node);
  return b;
}

void addDofs(const FeModel& model, const Eigen::VectorXd& step, Eigen::VectorXd& u) {
  for (int node = 0; node < model.nodeCount(); ++node)
    if (model.isFree(node)) u.segment<3>(3 * node) += step.segment<3>(model.dof(node));
}

/// Largest unbalanced force on a free node, relative to the largest internal force (reactions included).
double imbalance(const FeModel& model, const Eigen::VectorXd& internal, const Eigen::VectorXd& external) {
  const double scale = std::max(internal.cwiseAbs().maxCoeff(), external.cwiseAbs().maxCoeff());
  const double largest = toDofs(model, external - internal).cwiseAbs().maxCoeff();
  return scale > 0.0 ? largest / scale : 0.0;
}

struct LoadProblem {
  const FeModel& model;
  Cholesky& factor;
  const Eigen::VectorXd& load;

  void aim(double level, NewtonResult& /*state*/) { external = level * load; }
  double error(const NewtonResult& state) {
    internal = model.internalForce(state.u);
    return imbalance(model, internal, external);
  }
  void improve(NewtonResult& state, bool held) {
    if (!held) factor.factorize(state.u);
    addDofs(model, factor.solve(toDofs(model, external - internal)), state.u);
  }
  Eigen::VectorXd external, internal;
};

struct PatchProblem {
  const FeModel& model;
  Cholesky& factor;
  std::span<const ImposedPatch> tools;

  void aim(double to, NewtonResult& state) {
    level = to;
    state.forces.resize(tools.size(), Vec3::Zero());
  }
  double error(const NewtonResult& state) {
    internal = model.internalForce(state.u);
    external = Eigen::VectorXd::Zero(internal.size());
    double off = 0.0, scale = 1e-300;
    for (std::size_t a = 0; a < tools.size(); ++a) {
      tools[a].patch.addForce(state.forces[a], external);
      off = std::max(off, gap(state, a).norm());
      scale = std::max(scale, level * tools[a].d.norm());
    }
    return std::max(imbalance(model, internal, external), off / scale);
  }
  /// [K -G; G^T 0] [du; df] = [G f - f_int; d - G^T u], by the Schur complement of K, 3 x 3 for each pair of
  /// tools.
  void improve(NewtonResult& state, bool held) {
    if (!held) factor.factorize(state.u);
    const auto count = static_cast<Eigen::Index>(3 * tools.size());
    Eigen::MatrixXd b(model.dofCount(), count + 1);
    b.col(count) = toDofs(model, external - internal);
    Eigen::VectorXd gaps(count);
    for (Eigen::Index c = 0; c < count; ++c) {
      const auto a = static_cast<std::size_t>(c / 3);
      Eigen::VectorXd unit = Eigen::VectorXd::Zero(3 * model.nodeCount());
      tools[a].patch.addForce(Vec3::Unit(c % 3), unit);
      b.col(c) = toDofs(model, unit);
      gaps[c] = gap(state, a)[c % 3];
    }
    const Eigen::MatrixXd x = factor.solve(b);
    const Eigen::MatrixXd averages = b.leftCols(count).transpose() * x;
    const Eigen::VectorXd df = averages.leftCols(count).partialPivLu().solve(gaps - averages.col(count));
    addDofs(model, x.col(count) + x.leftCols(count) * df, state.u);
    for (std::size_t a = 0; a < tools.size(); ++a)
      state.forces[a] += df.segment<3>(static_cast<Eigen::Index>(3 * a));
  }
  /// Displacement that patch a still lacks, m.
  [[nodiscard]] Vec3 gap(const NewtonResult& state, std::size_t a) const {
    return level * tools[a].d - tools[a].patch.average(state.u);
  }
  double level{0.0};
  Eigen::VectorXd external, internal;
};

/// Newton at one level. @return whether it converged; state is then the solution
template <typename Problem>
bool converge(Problem& problem, NewtonResult& state, const NewtonOptions& options) {
  double previous = problem.error(state);
  bool held = false;  // the factor of an earlier iteration
  int lost = 0;
  for (int i = 0; i < options.max_iterations; ++i) {
    try {
      problem.improve(state, held);
    } catch (const std::runtime_error&) {
      return false;  // singular tangent: the caller takes a smaller step
    }
    ++state.iterations;
    if (!state.u.allFinite()) return false;  // patches that cannot move apart; a maximum would miss NaN
    state.residual = problem.error(state);
    if (!std::isfinite(state.residual) || state.residual > 1e6) return false;
    if (state.residual > options.lost && ++lost == 3) return false;
    // Rounding may keep the residual just above the tolerance; then it stops falling.
    const bool stagnated =
        !held && state.residual < 1e3 * options.tolerance && state.residual > 0.5 * previous;
    if (state.residual <= options.tolerance || stagnated) return true;
    held = state.residual < options.held * previous;
    previous = state.residual;
  }
  return false;
}

}  // namespace

template <typename Problem>
NewtonResult NewtonSolver::walk(Problem problem, const NewtonOptions& options) {
  NewtonResult state;
  state.u = Eigen::VectorXd::Zero(3 * model_.nodeCount());
  double level = 0.0;
  double step = 1.0 / std::max(options.steps, 1);
  int halvings = 0;
  int attempts_left = options.steps + options.extra_steps;
  while (level < 1.0) {
    NewtonResult attempt = state;
    const double next = level + step > 1.0 - 1e-9 ? 1.0 : level + step;
    problem.aim(next, attempt);
    if (converge(problem, attempt, options)) {
      state = attempt;
      level = next;
      halvings = 0;
    } else {
      ++halvings;
      step *= 0.5;
    }
    if (level < 1.0 && (halvings > options.max_halvings || --attempts_left <= 0))
      throw NoConvergence("Newton does not converge beyond " + std::to_string(level) +
                          " of the prescribed load (step " + std::to_string(step) + ")");
  }
  return state;
}

NewtonResult NewtonSolver::solveLoad(const Eigen::VectorXd& load, const NewtonOptions& options) {
  return walk(LoadProblem{model_, factor_, load, {}, {}}, options);
}

NewtonResult NewtonSolver::solvePatch(const Patch& patch, const Vec3& d, const NewtonOptions& options) {
  const ImposedPatch tool{patch, d};
  return solvePatches(std::span(&tool, 1), options);
}

NewtonResult NewtonSolver::solvePatches(std::span<const ImposedPatch> tools, const NewtonOptions& options) {
  const auto rests = [](const ImposedPatch& tool) { return tool.d.norm() == 0.0; };
  NewtonResult result;
  if (std::all_of(tools.begin(), tools.end(), rests)) {
    result.u = Eigen::VectorXd::Zero(3 * model_.nodeCount());
    result.forces.assign(tools.size(), Vec3::Zero());
    return result;
  }
  result = walk(PatchProblem{model_, factor_, tools, 0.0, {}, {}}, options);
  result.force = result.forces.front();
  return result;
}

std::optional<NewtonResult> NewtonSolver::solvePatchesFrom(const Eigen::VectorXd& start,
                                                           std::span<const ImposedPatch> tools,
                                                           const NewtonOptions& options) {
  PatchProblem problem{model_, factor_, tools, 0.0, {}, {}};
  NewtonResult state;
  state.u = start;
  problem.aim(1.0, state);
  if (!converge(problem, state, options)) return std::nullopt;
  state.force = state.forces.front();
  return state;
}

}  // namespace palpate::solver
