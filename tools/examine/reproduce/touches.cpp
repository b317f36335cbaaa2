// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/touches.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>

#include "core/data/model_view.h"
#include "core/model/field_evaluation.h"
#include "core/response/patch_response.h"
#include "core/response/response.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/fem/newton.h"

namespace palpate::reproduce {

namespace {

/// Areas of the triangles whose three nodes are contact positions, zero for the others.
std::vector<double> reachableAreas(const solver::SolverSetup& setup) {
  std::vector<bool> has_position(setup.surface.nodes.size(), false);
  for (std::size_t i = 0; i < setup.positions.nodes.size(); ++i)
    has_position[static_cast<std::size_t>(setup.positions.nodes[i])] = setup.positions.accessible[i] != 0;
  std::vector<double> areas;
  for (const auto& t : setup.surface.faces) {
    const auto corner = [&](std::size_t i) {
      return setup.surface.positions[static_cast<std::size_t>(t[i])];
    };
    const bool reachable = std::all_of(
        t.begin(), t.end(), [&](int node) { return has_position[static_cast<std::size_t>(node)]; });
    areas.push_back(reachable ? 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() : 0.0);
  }
  return areas;
}

/// C_s = G_s^T K0^-1 G_s, m/N.
Mat3 compliance(const solver::FeModel& model, const solver::Cholesky& K0, const solver::Patch& patch) {
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(model.dofCount(), 3);
  for (std::size_t i = 0; i < patch.nodes.size(); ++i)
    for (int c = 0; c < 3; ++c) G(model.dof(patch.nodes[i]) + c, c) = patch.weights[i];
  return G.transpose() * K0.solve(G);
}

/// The model's contact displacement d under f.
Vec3 displacementUnder(const MetaModel& model, const Touch& touch, Response& response) {
  if (model.attributes().parameters == Parameters::kForce) {
    if (respondToLoad(model, touch.s, touch.force, response) == ResponseStatus::kNoAnswer)
      throw std::runtime_error("a held-out point has no answer");
    return response.displacement;
  }
  // f(s, d) = f by Newton, from the true d.
  Vec3 d = touch.displacement;
  for (int i = 0; i < 20; ++i) {
    if (respond(model, touch.s, d, response) == ResponseStatus::kNoAnswer)
      throw std::runtime_error("a held-out point has no answer");
    const Vec3 step = response.stiffness.partialPivLu().solve(touch.force - response.force);
    if (!step.allFinite()) break;  // beyond the domain the force is constant
    d += step;
    if (step.norm() <= 1e-12 * d.norm()) break;
  }
  return d;
}

TouchError errorOf(const MetaModel& model, const Touch& touch, FieldScratch& scratch) {
  Response response;
  TouchError error;
  const double scale = touch.displacement.norm();
  const Vec3 d = displacementUnder(model, touch, response);
  std::vector<float> u(static_cast<std::size_t>(touch.surface.size()));
  const FieldSource source{touch.s, response.parameter, 1.0};
  evaluateField(model, std::span(&source, 1), scratch, u);
  for (Eigen::Index i = 0; i < touch.surface.size(); i += 3) {
    const Vec3 at = Eigen::Map<const Eigen::Vector3f>(u.data() + i).cast<double>();
    error.field = std::max(error.field, (at - touch.surface.segment<3>(i)).norm() / scale);
  }
  error.contact = (d - touch.displacement).norm() / scale;
  static_cast<void>(respond(model, touch.s, touch.displacement, response));
  error.force = (response.force - touch.force).norm() / touch.force.norm();
  return error;
}

}  // namespace

std::vector<Touch> drawPoints(const solver::SolverSetup& setup, int count, unsigned seed) {
  std::mt19937 random(seed);
  const std::vector<double> areas = reachableAreas(setup);
  if (std::none_of(areas.begin(), areas.end(), [](double area) { return area > 0.0; }))
    throw std::runtime_error("no triangle of the surface has three free nodes");
  std::discrete_distribution<int> triangle(areas.begin(), areas.end());
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Touch> touches;
  while (static_cast<int>(touches.size()) < count) {
    Touch touch;
    touch.s.triangle = triangle(random);
    const double root = std::sqrt(unit(random)), part = unit(random);
    touch.s.barycentric = {1.0 - root, root * (1.0 - part), root * part};
    touch.patch = solver::makePatch(setup.model, setup.surface, {touch.s.triangle, touch.s.barycentric},
                                    setup.patch_radius);
    touches.push_back(std::move(touch));
  }
  return touches;
}

void drawLoads(const solver::FeModel& model, const solver::Cholesky& K0, double travel, unsigned seed,
               std::vector<Touch>& touches) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (Touch& touch : touches) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Mat3 C = compliance(model, K0, touch.patch);
    touch.force = direction * (1.0 - unit(random)) * travel / (C * direction).norm();
  }
}

int limitLoads(const MetaModel& model, std::vector<Touch>& touches) {
  int limited = 0;
  for (Touch& touch : touches) {
    Response response;
    if (respondToLoad(model, touch.s, touch.force, response) != ResponseStatus::kBeyond) continue;
    touch.force = response.force;
    ++limited;
  }
  return limited;
}

void solveTouches(const solver::SolverSetup& setup, int workers, bool quiet, std::vector<Touch>& touches) {
  solver::Progress progress("full Newton", touches.size(), quiet);
  std::vector<std::unique_ptr<solver::NewtonSolver>> solvers(static_cast<std::size_t>(workers));
  solver::parallelFor(workers, touches.size(), [&](int worker, std::size_t i) {
    auto& solver = solvers[static_cast<std::size_t>(worker)];
    if (!solver) solver = std::make_unique<solver::NewtonSolver>(setup.model);
    Touch& touch = touches[i];
    Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * setup.model.nodeCount());
    touch.patch.addForce(touch.force, load);
    const Eigen::VectorXd u = solver->solveLoad(load, {}).u;
    touch.displacement = touch.patch.average(u);
    touch.surface.resize(3 * static_cast<Eigen::Index>(setup.surface.nodes.size()));
    for (std::size_t node = 0; node < setup.surface.nodes.size(); ++node)
      touch.surface.segment<3>(3 * static_cast<Eigen::Index>(node)) =
          u.segment<3>(3 * setup.surface.nodes[node]);
    progress.advance();
  });
}

std::vector<TouchError> errorsOf(const MetaModel& model, const std::vector<Touch>& touches) {
  FieldScratch scratch(model);
  std::vector<TouchError> errors;
  for (const Touch& touch : touches) errors.push_back(errorOf(model, touch, scratch));
  return errors;
}

double quantile(const std::vector<TouchError>& errors, double TouchError::*member, double q) {
  std::vector<double> values;
  for (const TouchError& error : errors) values.push_back(error.*member);
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size()))) - 1];
}

}  // namespace palpate::reproduce
