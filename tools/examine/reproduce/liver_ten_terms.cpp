// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/liver_ten_terms.h"

#include <algorithm>
#include <cstdio>

#include "tools/examine/reproduce/liver_organ.h"
#include "tools/examine/reproduce/touches.h"
#include "tools/make/organ/paper_liver.h"
#include "tools/solver/pgd/explicit_pgd.h"

namespace palpate::reproduce {

namespace {

using Eigen::VectorXd;

// m, median displacement of the contact under the load in linear theory
constexpr double kMedianTravel = 8e-3;

/// Evenly chosen positions, as touches under the study's load.
std::vector<Touch> someOf(const solver::SolverSetup& setup, const Vec3& load, int count,
                          std::vector<int>& positions) {
  const int M = static_cast<int>(setup.positions.nodes.size());
  std::vector<Touch> touches;
  for (int i = 0; i < std::min(count, M); ++i) {
    positions.push_back(static_cast<int>(std::int64_t(i) * M / std::min(count, M)));
    Touch touch;
    touch.patch = setup.positions.patches[static_cast<std::size_t>(positions.back())];
    touch.force = load;
    touches.push_back(std::move(touch));
  }
  return touches;
}

TouchError errorOf(const solver::SolverSetup& setup, const Touch& touch, const VectorXd& nodal) {
  TouchError error;
  const double scale = touch.displacement.norm();
  for (std::size_t i = 0; i < setup.surface.nodes.size(); ++i) {
    const Vec3 off = nodal.segment<3>(3 * setup.surface.nodes[i]) -
                     touch.surface.segment<3>(3 * static_cast<Eigen::Index>(i));
    error.field = std::max(error.field, off.norm() / scale);
  }
  error.contact = (touch.patch.average(nodal) - touch.displacement).norm() / scale;
  return error;
}

}  // namespace

void studyTenTerms(const LiverOptions& options, Output& out, Json& results) {
  if (!(options.coarse_element_size > 0.0)) return;
  char size[32];
  std::snprintf(size, sizeof size, "%.3g", 1e3 * options.coarse_element_size);
  out.step("ten terms, Eq. (19), on a liver of " + std::string(size) + " mm elements");
  const mesh::TetMesh mesh = organ::makePaperLiver(options.coarse_element_size);
  const solver::SolverSetup setup(wholeBoundary({}), mesh);
  double load = 1.0;
  const solver::BodyProblem problem = downwardProblem(setup, kMedianTravel, load);
  solver::ExplicitOptions pgd;
  pgd.steps = options.steps;
  pgd.tolerance = 0.03;  // dimples are a larger part of an organ's displacement than of a beam's
  pgd.workers = options.workers;
  pgd.quiet = out.quiet();
  const solver::LevelSolution solution = solver::solveExplicit(problem, pgd);
  std::vector<int> positions;
  std::vector<Touch> touches = someOf(setup, Vec3(0.0, 0.0, -load), options.samples, positions);
  solveTouches(setup, options.workers, out.quiet(), touches);
  const solver::Cholesky K0(problem.stiffness());
  std::vector<TouchError> separated, linear;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const VectorXd u = solver::evaluate(solution, positions[i], 1.0);
    const VectorXd u0 = K0.solve(VectorXd(problem.loads().col(positions[i])));
    separated.push_back(errorOf(setup, touches[i], problem.toNodes(u)));
    linear.push_back(errorOf(setup, touches[i], problem.toNodes(u0)));
  }
  results["ten_term"] = {{"element_size_mm", 1e3 * options.coarse_element_size},
                         {"tolerance", pgd.tolerance},
                         {"residual", *std::max_element(solution.residual.begin(), solution.residual.end())},
                         {"nodes", setup.model.nodeCount()},
                         {"tetrahedra", setup.model.elementCount()},
                         {"positions", setup.positions.nodes.size()},
                         {"steps", options.steps},
                         {"load_N", load},
                         {"pairs", solution.pairs},
                         {"level_functions", solution.levels()},
                         {"seconds", solution.seconds},
                         {"samples", touches.size()},
                         {"field_error_p95", quantile(separated, &TouchError::field, 0.95)},
                         {"contact_error_p95", quantile(separated, &TouchError::contact, 0.95)},
                         {"linear_field_error_p95", quantile(linear, &TouchError::field, 0.95)},
                         {"linear_contact_error_p95", quantile(linear, &TouchError::contact, 0.95)}};
}

}  // namespace palpate::reproduce
