// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/explicit_pgd.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/solver/base/progress.h"
#include "tools/solver/pgd/separated_increment.h"

namespace palpate::solver {

namespace {

void check(const ExplicitOptions& options) {
  const auto atLeastOne = [](const char* name, int value) {
    if (value < 1)
      throw std::invalid_argument(std::string("load stepping: ") + name + " is " + std::to_string(value) +
                                  "; expected at least 1");
  };
  atLeastOne("steps", options.steps);
  atLeastOne("max_pairs", options.max_pairs);
  atLeastOne("sweeps", options.sweeps);
  atLeastOne("max_levels", options.max_levels);
  atLeastOne("probes", options.probes);
  if (!(options.tolerance > 0.0))
    throw std::invalid_argument("load stepping: tolerance is " + std::to_string(options.tolerance) +
                                "; expected a positive number");
}

/// Adds pairs until the residual of this step is small, or X is full. @return the residual
double enrich(SeparatedIncrement& increment, const ExplicitOptions& options) {
  const int full = std::min(options.max_pairs, static_cast<int>(increment.X().rows()));
  double residual = increment.residual();
  while (residual > options.tolerance && increment.pairs() < full && increment.enrich())
    residual = increment.residual();
  return residual;
}

/// Cuts X to the modes that carry the history up to half the tolerance. @return whether it removed any
bool recompress(SeparatedIncrement& increment, LevelHistory& history, double tolerance) {
  history.X = increment.X();
  const HistoryModes modes = historyModes(history, increment.positionWeights());
  const double allowed = 0.25 * tolerance * tolerance * modes.energy.sum();
  Eigen::Index count = modes.energy.size();
  for (double tail = 0.0; count > 1; --count) {
    tail += modes.energy[count - 1];
    if (tail > allowed) break;
  }
  if (count == modes.energy.size()) return false;
  const Eigen::MatrixXd V = modes.V.leftCols(count);
  for (Eigen::MatrixXd& Y : history.Y) Y = (V.topRows(Y.rows()).transpose() * Y).eval();
  increment.rotate(V);
  return true;
}

/// One load step. @return its residual
double walk(SeparatedIncrement& increment, const ExplicitOptions& options, double from, double to) {
  const std::string where = "load stepping: at load level " + std::to_string(to) + " ";
  double residual = 0.0;
  try {
    increment.begin(from, to);
    residual = enrich(increment, options);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(where + "of 1: " + error.what());
  }
  increment.finish();
  if (!increment.Y().allFinite())
    throw std::runtime_error(where + "the solution is not finite; the scheme diverges under this load");
  return residual;
}

}  // namespace

LevelSolution solveExplicit(const ParametricProblem& problem, const ExplicitOptions& options) {
  check(options);
  Progress progress("load steps", static_cast<std::size_t>(options.steps), options.quiet);
  SeparatedIncrement increment(problem, options);
  LevelHistory history;
  std::vector<int> born;
  std::vector<double> residuals;
  int recompressions = 0;
  for (int j = 1; j <= options.steps; ++j) {
    const double level = static_cast<double>(j) / options.steps;
    const int before = increment.pairs();
    residuals.push_back(walk(increment, options, static_cast<double>(j - 1) / options.steps, level));
    history.Y.push_back(increment.Y());
    born.push_back(increment.pairs() - before);
    if (residuals.back() > options.tolerance && recompress(increment, history, options.tolerance))
      ++recompressions;
    progress.advance();
  }
  history.X = increment.X();
  LevelSolution solution = separateLevels(std::move(history), increment.positionWeights(),
                                          {options.modes, options.level_tolerance, options.max_levels});
  solution.born = std::move(born);
  solution.residual = std::move(residuals);
  solution.recompressions = recompressions;
  solution.seconds = progress.seconds();
  return solution;
}

}  // namespace palpate::solver
