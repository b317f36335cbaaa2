// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/linear_pgd.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/solver/base/progress.h"
#include "tools/solver/pgd/alternating_directions.h"
#include "tools/solver/pgd/residual_estimate.h"

namespace palpate::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void require(bool good, const char* field, double value, const char* expected) {
  if (!good)
    throw std::invalid_argument(std::string("linear PGD: ") + field + " = " + std::to_string(value) +
                                ", expected " + expected);
}

void check(const LinearPgdOptions& o, int dofs) {
  require(o.load_terms >= 0, "load_terms", o.load_terms, ">= 0");
  require(o.max_pairs >= 1, "max_pairs", o.max_pairs, ">= 1");
  require(o.tolerance >= 0.0 && o.tolerance < 1.0, "tolerance", o.tolerance, "in [0, 1)");
  require(o.max_sweeps >= 1, "max_sweeps", o.max_sweeps, ">= 1");
  require(o.pair_tolerance >= 0.0, "pair_tolerance", o.pair_tolerance, ">= 0");
  require(o.update >= 0, "update", o.update, ">= 0");
  require(o.block >= 1, "block", o.block, ">= 1");
  require(o.residual_every >= 1, "residual_every", o.residual_every, ">= 1");
  require(o.probes >= 2, "probes", o.probes, ">= 2");
  require(o.workers >= 1, "workers", o.workers, ">= 1");
  const auto given = static_cast<double>(o.components.size());
  require(o.components.empty() || given == dofs, "size of components", given, "one for each unknown");
  for (const int c : o.components) require(c >= 0, "a component", c, ">= 0");
}

std::vector<int> componentsOf(const LinearPgdOptions& options, int dofs) {
  if (options.separation == Separation::kScalar) return {};
  std::vector<int> components = options.components.empty() ? bodyComponents(dofs) : options.components;
  // One component is a scalar pair.
  const bool several = std::any_of(components.begin(), components.end(), [](int c) { return c > 0; });
  return several ? components : std::vector<int>{};
}

/// Products of the X for the energy and for the Galerkin step of all Y.
class Greedy {
 public:
  Greedy(const ParametricProblem& problem, const LinearPgdOptions& options);
  SeparatedSolution run();

 private:
  void add(const NewPairs& pairs);
  void update();
  bool finished(int sweeps);
  void estimate(int sweeps);
  [[nodiscard]] double captured() const;
  [[nodiscard]] MatrixXd stackedY() const;

  const SparseMatrix& K_;
  VectorXd weights_;
  LinearPgdOptions options_;
  std::vector<int> components_;
  SeparatedLoad load_;
  AlternatingDirections directions_;
  ResidualEstimate estimate_;
  SeparatedSolution u_;
  MatrixXd gram_;        // a(X_k e_i, X_l e_j), (n components)^2
  MatrixXd load_on_X_;   // l_s(X_k e_i), (n components) x M
  int updated_at_{0};    // pairs
  int estimated_at_{0};  // pairs
  double best_energy_{0.0};
  Progress progress_;
};

Greedy::Greedy(const ParametricProblem& problem, const LinearPgdOptions& options)
    : K_(problem.stiffness()),
      weights_(problem.weights()),
      options_(options),
      components_(componentsOf(options, problem.dofs())),
      load_(problem.loads(), weights_, options.load_terms, options.seed),
      directions_(K_, load_, weights_, options, components_),
      estimate_(K_, load_, weights_, options.probes, options.seed,
                [this](const MatrixXd& B) { return directions_.solve(B); }),
      progress_("linear PGD, pairs", static_cast<std::size_t>(options.max_pairs), options.quiet) {
  u_.X.resize(problem.dofs(), 0);
  u_.Y.assign(static_cast<std::size_t>(directions_.componentCount()), MatrixXd(0, weights_.size()));
  u_.components = components_;
  u_.load_error = load_.truncationError();
}

MatrixXd Greedy::stackedY() const {
  return u_.scalarPairs().Y;
}

/// 2 l(u^n) - |u^n|^2: the part of the solution's energy that u^n holds.
double Greedy::captured() const {
  const MatrixXd Y = stackedY();
  return (Y.cwiseProduct(2.0 * load_on_X_ - gram_ * Y)).colwise().sum().dot(weights_);
}

void Greedy::add(const NewPairs& pairs) {
  const MatrixXd R = byComponent(pairs.R, components_, u_.terms());
  const MatrixXd KR = K_ * R;
  const Index before = gram_.rows();
  u_.append(pairs.R, pairs.S);
  const MatrixXd cross = byComponent(u_.X, components_, u_.terms()).transpose() * KR;
  gram_.conservativeResize(before + R.cols(), before + R.cols());
  gram_.rightCols(R.cols()) = cross;
  gram_.bottomRows(R.cols()) = cross.transpose();
  load_on_X_.conservativeResize(before + R.cols(), weights_.size());
  load_on_X_.bottomRows(R.cols()) = load_.project(R);
}

/// Updates all Y for fixed X: sum_l a(X_k, X_l) Y_l(s) = l_s(X_k).               docs/design.md, Reproduction
void Greedy::update() {
  MatrixXd gram = gram_;
  gram.diagonal().array() += 1e-14;  // the X have norm 1; for a component without any displacement
  const Eigen::LDLT<MatrixXd> factor(gram);
  if (factor.info() != Eigen::Success)
    throw std::runtime_error("the energy products of " + std::to_string(u_.pairs()) +
                             " pairs have no factor");
  const MatrixXd Y = factor.solve(load_on_X_);
  for (Index c = 0; c < u_.terms(); ++c)
    u_.Y[static_cast<std::size_t>(c)] = Y(Eigen::seqN(c, u_.pairs(), u_.terms()), Eigen::all);
  updated_at_ = static_cast<int>(u_.pairs());
}

void Greedy::estimate(int sweeps) {
  estimated_at_ = static_cast<int>(u_.pairs());
  const ResidualEstimate::Result residual = estimate_(u_, captured());
  u_.history.push_back({estimated_at_, sweeps, residual.relative, residual.spread, progress_.seconds()});
}

/// Estimates the residual every few pairs. @return whether to stop
bool Greedy::finished(int sweeps) {
  const int pairs = static_cast<int>(u_.pairs());
  const bool full = pairs >= options_.max_pairs;
  if (!full && pairs - estimated_at_ < options_.residual_every) return false;
  estimate(sweeps);
  return full || u_.history.back().residual <= options_.tolerance;
}

SeparatedSolution Greedy::run() {
  constexpr double kNothing = 1e-30;  // of the strongest pairs' energy: below is rounding
  const int block = components_.empty() ? options_.block : 1;
  for (bool done = false; !done;) {
    const int wanted = std::min(block, options_.max_pairs - static_cast<int>(u_.pairs()));
    const NewPairs pairs = directions_.enrich(u_, wanted);
    if (pairs.R.cols() == 0 || pairs.energy <= kNothing * best_energy_) break;
    best_energy_ = std::max(best_energy_, pairs.energy);
    add(pairs);
    const int n = static_cast<int>(u_.pairs());
    if (options_.update > 0 && n - updated_at_ >= options_.update) update();
    progress_.advance(static_cast<std::size_t>(pairs.R.cols()));
    done = finished(pairs.sweeps);
  }
  const int n = static_cast<int>(u_.pairs());
  const bool stale = options_.update > 0 && n > updated_at_;
  if (stale) update();
  if (stale || n > estimated_at_) estimate(0);
  return std::move(u_);
}

}  // namespace

std::vector<int> bodyComponents(int dofs) {
  std::vector<int> components(static_cast<std::size_t>(dofs));
  for (int i = 0; i < dofs; ++i) components[static_cast<std::size_t>(i)] = i % 3;
  return components;
}

SeparatedSolution solveLinearPgd(const ParametricProblem& problem, const LinearPgdOptions& options) {
  check(options, problem.dofs());
  return Greedy(problem, options).run();
}

}  // namespace palpate::solver
