// SPDX-License-Identifier: Apache-2.0
// The rod of Section 4.1: convergence of three schemes with the load step (Figure 1), and the series beside them.
#include "tools/examine/reproduce/rod_study.h"

#include <cmath>

#include "tools/examine/reproduce/figures.h"
#include "tools/solver/pgd/explicit_pgd.h"
#include "tools/solver/pgd/rod.h"

namespace palpate::reproduce {

namespace {

using solver::LoadStepping;

struct Scheme {
  LoadStepping scheme;
  const char* key;
  const char* name;
};
constexpr Scheme kSchemes[] = {{LoadStepping::kTenTerms, "ten_term", "ten terms, Eq. (19)"},
                               {LoadStepping::kForwardEuler, "forward_euler", "forward Euler, Remark 2"},
                               {LoadStepping::kConstantTangent, "constant_tangent", "constant tangent"}};

/// u at full load for every load position, nodes x positions, m.
Eigen::MatrixXd fullLoad(const solver::LevelSolution& solution, int positions) {
  Eigen::MatrixXd u(solution.X.rows(), positions);
  for (int s = 0; s < positions; ++s) u.col(s) = solver::evaluate(solution, s, 1.0);
  return u;
}

/// Relative errors of one run.
Json runScheme(const solver::RodProblem& rod, LoadStepping scheme, int steps, const RodOptions& options) {
  solver::ExplicitOptions pgd;
  pgd.scheme = scheme;
  pgd.steps = steps;
  pgd.tolerance = 1e-12;  // so only the scheme's own error remains
  pgd.max_pairs = rod.dofs();
  pgd.workers = options.workers;
  pgd.quiet = true;
  const double start = now();
  const solver::LevelSolution solution = solver::solveExplicit(rod, pgd);
  const Eigen::MatrixXd exact = solver::exactSolution(rod);
  const Eigen::MatrixXd error = fullLoad(solution, rod.positions()) - exact;
  const double tip = exact(exact.rows() - 1, exact.cols() - 1);
  return {{"dt", 1.0 / steps},
          {"steps", steps},
          {"tip_error", std::abs(error(error.rows() - 1, error.cols() - 1)) / tip},
          {"field_error", error.cwiseAbs().maxCoeff() / tip},
          {"pairs", solution.X.cols()},
          {"seconds", now() - start}};
}

/// Slope of log(error) over log(step) by least squares, over steps of at most 1e-2.
double order(const Json& rows) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Json& row : rows) {
    if (row["dt"].get<double>() > 0.0101) continue;
    const double log_dt = std::log(row["dt"].get<double>()), log_e = std::log(row["tip_error"].get<double>());
    n += 1.0;
    x += log_dt;
    y += log_e;
    xx += log_dt * log_dt;
    xy += log_dt * log_e;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

Json problemOf(const solver::RodProblem& rod) {
  const solver::RodData& data = rod.data();
  const double K = data.loadNumber();
  const double stretch = solver::exactStretch(K);
  return {{"length_mm", 1e3 * data.length},
          {"area_mm2", 1e6 * data.area},
          {"E_MPa", 1e-6 * data.E},
          {"force_N", data.force},
          {"elements", data.elements},
          {"K", K},
          {"stretch", stretch},
          {"formula_without_length", stretch - 1.0},
          {"exact_tip_mm", 1e3 * solver::exactTip(K, data.length)}};
}

/// The displacement-driven series at the tip, order 1 to 5: error of the displacement for a given force.
Json seriesErrors(const solver::RodProblem& rod) {
  const double tip = solver::exactTip(rod.data().loadNumber(), rod.data().length);
  Json rows = Json::array();
  for (int p = 1; p <= 5; ++p) {
    const solver::RodSeries series = solver::rodSeries(rod, rod.dofs() - 1, p);
    rows.push_back(
        {{"order", p}, {"tip_error", std::abs(series.displacement(rod.data().force) - tip) / tip}});
  }
  return rows;
}

void writeFigure(const Json& results, Output& out) {
  Chart chart{"Rod: error of the tip over the load step (paper: Figure 1)",
              "load step",
              "relative error",
              true,
              true,
              {}};
  std::vector<std::vector<double>> rows;
  for (const Scheme& scheme : kSchemes) {
    Curve curve{scheme.name, {}};
    for (const Json& row : results.at(scheme.key)) {
      curve.points.emplace_back(row["dt"].get<double>(), row["tip_error"].get<double>());
      rows.push_back(numbersOf(row, {"dt", "tip_error", "field_error", "pairs"}));
      rows.back().insert(rows.back().begin(), double(scheme.scheme));
    }
    chart.curves.push_back(curve);
  }
  chart.curves.push_back({"the paper's statement: 1e-4 at 1e-3", {{1e-3, 1e-4}}});
  out.writeCsv("figure-1-rod-convergence.csv", {"scheme", "dt", "tip_error", "field_error", "pairs"}, rows);
  drawChart(out.file("figure-1-rod-convergence.svg"), chart);
}

}  // namespace

Json reproduceRod(const RodOptions& options, Output& out) {
  const double start = now();
  out.step("the rod and its exact solution, Eqs. (20)-(21)");
  solver::RodData data;
  data.elements = options.elements;
  const solver::RodProblem rod(data);
  Json results = problemOf(rod);
  for (const Scheme& scheme : kSchemes) {
    out.step(std::string(scheme.name) + ": load steps 1/" + std::to_string(options.steps.front()) + " to 1/" +
             std::to_string(options.steps.back()));
    for (const int steps : options.steps)
      results[scheme.key].push_back(runScheme(rod, scheme.scheme, steps, options));
    results["order"][scheme.key] = order(results[scheme.key]);
    results["finest"][scheme.key] = results[scheme.key].back()["tip_error"];
  }
  results["finest"]["field_ten_term"] = results["ten_term"].back()["field_error"];
  results["pairs"] = results["ten_term"].back()["pairs"];
  out.step("displacement-driven series, order 1 to 5");
  results["series_displacement"] = seriesErrors(rod);
  out.step("Figure 1");
  writeFigure(results, out);
  results["seconds"] = now() - start;
  return results;
}

}  // namespace palpate::reproduce
