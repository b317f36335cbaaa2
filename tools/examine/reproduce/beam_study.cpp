// SPDX-License-Identifier: Apache-2.0
// The beam of Section 4.2: all positions of the load on the upper surface, ten terms and forward Euler against Newton.
#include "tools/examine/reproduce/beam_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "tools/examine/reproduce/beam_figures.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/fem/newton.h"
#include "tools/solver/fit/field_measures.h"
#include "tools/solver/pgd/explicit_pgd.h"

namespace palpate::reproduce {

namespace {

using Eigen::VectorXd;
using solver::LevelSolution;
using solver::LoadStepping;

constexpr int kLevels = 10;

VectorXd solveFully(const Beam& beam, solver::NewtonSolver& solver, int position, double level) {
  const VectorXd load = level * VectorXd(beam.problem.loads().col(position));
  return beam.toUnknowns(solver.solveLoad(beam.problem.toNodes(load), {}).u);
}

void solveNewton(const Beam& beam, const BeamOptions& options, bool quiet, BeamSolutions& solutions) {
  const auto positions = static_cast<std::size_t>(beam.problem.positions());
  solutions.newton.resize(positions);
  solutions.levels.resize(kLevels);
  solver::Progress progress("full Newton", positions + kLevels, quiet);
  std::vector<std::unique_ptr<solver::NewtonSolver>> solvers(static_cast<std::size_t>(options.workers));
  solver::parallelFor(options.workers, positions + kLevels, [&](int worker, std::size_t i) {
    auto& solver = solvers[static_cast<std::size_t>(worker)];
    if (!solver) solver = std::make_unique<solver::NewtonSolver>(beam.model);
    if (i < positions)
      solutions.newton[i] = solveFully(beam, *solver, static_cast<int>(i), 1.0);
    else
      solutions.levels[i - positions] =
          solveFully(beam, *solver, beam.tip, double(i - positions + 1) / kLevels);
    progress.advance();
  });
}

LevelSolution solveSeparated(const solver::BodyProblem& problem, LoadStepping scheme,
                             const BeamOptions& options, double tolerance, bool quiet) {
  solver::ExplicitOptions pgd;
  pgd.scheme = scheme;
  pgd.steps = options.steps;
  pgd.tolerance = tolerance;
  pgd.workers = options.workers;
  pgd.quiet = quiet;
  return solver::solveExplicit(problem, pgd);
}

/// Relative L2 error of unknowns. paper 4.2
double errorL2(const Beam& beam, const VectorXd& u, const VectorXd& reference) {
  return solver::relativeErrorL2(beam.model, beam.problem.toNodes(u), beam.problem.toNodes(reference));
}

/// The scheme without separation: the load at the tip alone, enriched down to a tiny residual.
VectorXd solveAlone(const Beam& beam, LoadStepping scheme, const BeamOptions& options) {
  constexpr double kExact = 1e-6;
  const solver::SparseMatrix load = beam.problem.loads().col(beam.tip);
  const solver::BodyProblem problem(beam.model, load, Eigen::VectorXd::Ones(1));
  return solver::evaluate(solveSeparated(problem, scheme, options, kExact, true), 0, 1.0);
}

double tipDown(const Beam& beam, const VectorXd& u) {
  return -1e3 * u[beam.model.dof(beam.nodes[static_cast<std::size_t>(beam.tip)]) + 2];
}

/// Change of the length of the beam's axis, the polyline through the nodes nearest to it.
double axisStretch(const Beam& beam, const VectorXd& unknowns) {
  const VectorXd u = beam.problem.toNodes(unknowns);
  double rest = 0.0, length = 0.0;
  for (std::size_t i = 0; i + 1 < beam.axis.size(); ++i) {
    const auto a = static_cast<std::size_t>(beam.axis[i]), b = static_cast<std::size_t>(beam.axis[i + 1]);
    const solver::Vec3 edge = beam.model.nodes()[b] - beam.model.nodes()[a];
    rest += edge.norm();
    length += (edge + u.segment<3>(3 * beam.axis[i + 1]) - u.segment<3>(3 * beam.axis[i])).norm();
  }
  return length / rest - 1.0;
}

/// Error and tip displacement of each position.
void addPositions(const Beam& beam, const BeamOptions& options, const BeamSolutions& solutions,
                  Json& results) {
  std::vector<double> errors;
  double least_tip = std::numeric_limits<double>::infinity();
  for (int s = 0; s < beam.problem.positions(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    const VectorXd u = solver::evaluate(solutions.ten_term, s, 1.0);
    errors.push_back(errorL2(beam, u, solutions.newton[i]));
    const solver::Vec3& x = beam.model.nodes()[static_cast<std::size_t>(beam.nodes[i])];
    least_tip = std::min(least_tip, tipDown(beam, solutions.newton[i]));
    results["positions"].push_back({{"node", beam.mesh.node_tags[static_cast<std::size_t>(beam.nodes[i])]},
                                    {"x_mm", 1e3 * x.x()},
                                    {"y_mm", 1e3 * x.y()},
                                    {"force_N", options.load},
                                    {"newton_tip_mm", tipDown(beam, solutions.newton[i])},
                                    {"l2_error", errors.back()}});
  }
  results["least_tip_mm"] = least_tip;
  std::sort(errors.begin(), errors.end());
  const auto rank = [&](double q) { return errors[static_cast<std::size_t>(q * double(errors.size() - 1))]; };
  results["positions_count"] = errors.size();
  results["l2_error_max"] = errors.back();
  results["l2_error_p95"] = rank(0.95);
  results["l2_error_median"] = rank(0.5);
}

void addTip(const Beam& beam, const BeamSolutions& solutions, Json& results) {
  const auto tip = static_cast<std::size_t>(beam.tip);
  const double newton = tipDown(beam, solutions.newton[tip]);
  const VectorXd ten = solver::evaluate(solutions.ten_term, beam.tip, 1.0);
  const VectorXd euler = solver::evaluate(solutions.forward_euler, beam.tip, 1.0);
  const std::pair<const char*, const VectorXd*> solutionsAtTip[] = {{"linear", &solutions.linear},
                                                                    {"ten_term", &ten},
                                                                    {"newton", &solutions.newton[tip]},
                                                                    {"forward_euler", &euler}};
  Json out, volume, det, axis;
  out["node"] = beam.mesh.node_tags[static_cast<std::size_t>(beam.nodes[tip])];
  out["newton_mm"] = newton;
  for (const auto& [key, u] : solutionsAtTip) {
    const VectorXd nodal = beam.problem.toNodes(*u);
    volume[key] = solver::volumeChange(beam.model, nodal);
    det[key] = beam.model.minDetF(nodal);
    axis[key] = axisStretch(beam, *u);
    if (std::string(key) == "newton") continue;
    out[std::string(key) + "_mm"] = tipDown(beam, *u);
    out[std::string(key) + "_error"] = tipDown(beam, *u) / newton - 1.0;
    out[std::string(key) + "_l2_error"] = errorL2(beam, *u, solutions.newton[tip]);
  }
  for (const auto& [key, u] : {std::pair{"ten_term_alone", &solutions.ten_term_alone},
                               {"forward_euler_alone", &solutions.forward_euler_alone}}) {
    out[std::string(key) + "_mm"] = tipDown(beam, *u);
    out[std::string(key) + "_error"] = tipDown(beam, *u) / newton - 1.0;
  }
  const double off = out["forward_euler_error"].get<double>();
  out["forward_euler_size"] = std::abs(off);
  out["forward_euler_word"] = off < 0.0 ? "short" : "long";
  // Tension of the stretched axis.
  results["forward_euler_tension_N"] = axis["forward_euler"].get<double>() * beam.axialStiffness();
  results["axial_stiffness_N"] = beam.axialStiffness();
  const double ratio = std::abs(volume["ten_term"].get<double>() / volume["linear"].get<double>());
  results["volume_ratio"] = ratio;
  results["volume_verdict"] = ratio < 0.05 ? ": the claim holds" : ": the claim does not hold here";
  out["newton_share"] = 1e-3 * newton / beam.model.nodes().back().x();
  results["tip"] = out;
  results["volume_change"] = volume;
  results["min_det_f"] = det;
  results["axis_stretch"] = axis;
}

void addCurve(const Beam& beam, const BeamSolutions& solutions, Json& results) {
  for (int i = 0; i < kLevels; ++i) {
    const double t = double(i + 1) / kLevels;
    const VectorXd& newton = solutions.levels[static_cast<std::size_t>(i)];
    const VectorXd ten = solver::evaluate(solutions.ten_term, beam.tip, t);
    results["load_curve"].push_back(
        {{"level", t},
         {"newton_mm", tipDown(beam, newton)},
         {"ten_term_mm", tipDown(beam, ten)},
         {"forward_euler_mm", tipDown(beam, solver::evaluate(solutions.forward_euler, beam.tip, t))},
         {"linear_mm", t * tipDown(beam, solutions.linear)},
         {"ten_term_l2_error", errorL2(beam, ten, newton)}});
  }
}

Json problemOf(const Beam& beam, const BeamOptions& options) {
  return {{"nodes", beam.model.nodeCount()},
          {"tetrahedra", beam.model.elementCount()},
          {"E_MPa", 1e-6 * beam.model.material().elasticity.E},
          {"nu", beam.model.material().elasticity.nu},
          {"nodes_along", std::to_string(options.nodes[0]) + " x " + std::to_string(options.nodes[1]) +
                              " x " + std::to_string(options.nodes[2])},
          {"load_N", options.load},
          {"tolerance", options.tolerance},
          {"steps", options.steps},
          {"positions", Json::array()}};
}

}  // namespace

Json reproduceBeam(const BeamOptions& options, Output& out) {
  const double start = now();
  out.step("the beam and its load positions");
  const Beam beam(options);
  Json results = problemOf(beam, options);
  BeamSolutions solutions;
  const auto timed = [&](const char* key, auto&& work) {
    const double before = now();
    work();
    results["seconds"][key] = now() - before;
  };
  out.step("ten terms, Eq. (19), all positions at once, " + std::to_string(options.steps) + " load steps");
  timed("ten_term", [&] {
    solutions.ten_term =
        solveSeparated(beam.problem, LoadStepping::kTenTerms, options, options.tolerance, out.quiet());
  });
  out.step("forward Euler, Remark 2");
  timed("forward_euler", [&] {
    solutions.forward_euler =
        solveSeparated(beam.problem, LoadStepping::kForwardEuler, options, options.tolerance, out.quiet());
  });
  out.step("both schemes without separation, load at the tip");
  timed("alone", [&] {
    solutions.ten_term_alone = solveAlone(beam, LoadStepping::kTenTerms, options);
    solutions.forward_euler_alone = solveAlone(beam, LoadStepping::kForwardEuler, options);
  });
  out.step("full Newton at every position, and over the load at the tip");
  timed("newton", [&] { solveNewton(beam, options, out.quiet(), solutions); });
  out.step("errors, volume, forward Euler beside the paper's Figure 4");
  solutions.linear = solver::Cholesky(beam.problem.stiffness()).solve(beam.problem.loads().col(beam.tip));
  results["pairs"] = solutions.ten_term.X.cols();
  results["level_functions"] = solutions.ten_term.Z.rows();
  results["pairs_linear"] = solutions.ten_term.born.front();
  addPositions(beam, options, solutions, results);
  addTip(beam, solutions, results);
  addCurve(beam, solutions, results);
  out.step("Figures 2 to 4");
  writeFigures(beam, solutions, results, out);
  results["seconds"]["total"] = now() - start;
  return results;
}

}  // namespace palpate::reproduce
