// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/full_solution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "core/data/model_view.h"
#include "tools/examine/query/query_error.h"

namespace palpate::query {

namespace {

template <std::size_t K>
std::vector<std::array<std::int32_t, K>> tuples(std::span<const std::int32_t> flat) {
  std::vector<std::array<std::int32_t, K>> list(flat.size() / K);
  for (std::size_t i = 0; i < flat.size(); ++i) list[i / K][i % K] = flat[i];
  return list;
}

std::vector<Vec3> points(std::span<const double> flat) {
  std::vector<Vec3> list;
  for (std::size_t i = 0; i + 2 < flat.size(); i += 3) list.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  return list;
}

solver::Material materialOf(const ModelAttributes& a, const modelfile::VolumeMesh& mesh) {
  solver::Material material{{a.E, a.nu}, solver::lawOf(a.law), {}, mesh.element_region};
  for (std::size_t r = 0; r < mesh.region_name.size(); ++r)
    material.regions.push_back({textOf(mesh.region_name[r]),
                                {mesh.region_E[r], mesh.region_nu[r]},
                                solver::lawOf(textOf(mesh.region_law[r]))});
  return material;
}

std::vector<solver::Spring> springsOf(const modelfile::VolumeMesh& mesh) {
  std::vector<solver::Spring> springs;
  for (std::size_t s = 0; s < mesh.spring_node.size(); ++s)
    springs.push_back({mesh.spring_node[s], mesh.spring_stiffness[s]});
  return springs;
}

solver::FeModel bodyOf(const ModelAttributes& a, const modelfile::VolumeMesh& mesh) {
  try {
    return solver::FeModel(points(mesh.nodes), {tuples<4>(mesh.tetrahedra), tuples<6>(mesh.midsides)},
                           mesh.fixed, materialOf(a, mesh), springsOf(mesh));
  } catch (const std::invalid_argument& error) {
    throw QueryError(std::string("the mesh in the model file: ") + error.what());
  }
}

std::string text(const Vec3& v) {
  std::ostringstream out;
  out << v[0] << ',' << v[1] << ',' << v[2];
  return out.str();
}

/// The nodal forces of a point load: the corners' shape functions, free nodes only.
solver::Patch pointPatch(const Organ& organ, const ContactPoint& s) {
  solver::Patch patch;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t corner = organ.surface.faces[static_cast<std::size_t>(s.triangle)][k];
    const std::int32_t node = organ.surface.nodes[static_cast<std::size_t>(corner)];
    if (s.barycentric[k] <= 0.0 || !organ.body.isFree(node)) continue;
    patch.nodes.push_back(node);
    patch.weights.push_back(s.barycentric[k]);
    patch.free_share += s.barycentric[k];
  }
  for (double& weight : patch.weights) weight /= patch.free_share;
  return patch;
}

solver::NewtonOptions stepsOf(int steps) {
  solver::NewtonOptions options;
  options.steps = steps;
  return options;
}

double ratio(double error, double reference) {
  return error == 0.0 ? 0.0 : error / reference;
}

}  // namespace

Organ organOf(const MetaModel& model, modelfile::VolumeMesh mesh) {
  solver::FeModel body = bodyOf(model.attributes(), mesh);
  solver::PatchSurface surface(body, mesh.surface_node, tuples<3>(model.view().surface_triangles),
                               tuples<3>(model.view().contact_triangles));
  return {std::move(body), std::move(surface), std::move(mesh)};
}

solver::Patch patchAt(const Organ& organ, const Anchor& anchor, double patch_radius) {
  constexpr double kLeastRadius = 1e-9;  // m; below, its square vanishes, and no mesh is that fine
  solver::Patch patch =
      solver::makePatch(organ.body, organ.surface, anchor.s, std::max(patch_radius, kLeastRadius));
  if (patch.nodes.empty()) patch = pointPatch(organ, anchor.s);
  if (patch.nodes.empty())
    throw QueryError("the contact patch at " + text(anchor.position) +
                     " lies on clamped nodes only: nothing to solve");
  return patch;
}

FullSolution solveFully(const Organ& organ, const Anchor& anchor, double patch_radius, const Vec3& d,
                        int steps) {
  FullSolution solution;
  solution.patch = patchAt(organ, anchor, patch_radius);
  solution.d = d;
  try {
    solution.state = solver::NewtonSolver(organ.body).solvePatch(solution.patch, d, stepsOf(steps));
  } catch (const std::runtime_error& error) {
    throw QueryError("displacement " + text(d) + " m: " + error.what());
  }
  solution.min_det_f = organ.body.minDetF(solution.state.u);
  return solution;
}

FullSolution solveUnderLoad(const Organ& organ, const Anchor& anchor, double patch_radius, const Vec3& f,
                            int steps) {
  FullSolution solution;
  solution.patch = patchAt(organ, anchor, patch_radius);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * organ.body.nodeCount());
  solution.patch.addForce(f, load);
  try {
    solution.state = solver::NewtonSolver(organ.body).solveLoad(load, stepsOf(steps));
  } catch (const std::runtime_error& error) {
    throw QueryError("force " + text(f) + " N: " + error.what());
  }
  solution.state.force = f;
  solution.d = solution.patch.average(solution.state.u);
  solution.min_det_f = organ.body.minDetF(solution.state.u);
  return solution;
}

FullSolution solveTogether(const Organ& organ, std::span<const Touch> touches, double patch_radius,
                           int steps) {
  std::vector<solver::ImposedPatch> tools;
  std::string asked;
  for (const Touch& touch : touches) {
    tools.push_back({patchAt(organ, touch.anchor, patch_radius), touch.d});
    asked += (asked.empty() ? "" : " and ") + text(touch.d);
  }
  FullSolution solution;
  solution.patch = tools.front().patch;
  solution.d = touches.front().d;
  try {
    solution.state = solver::NewtonSolver(organ.body).solvePatches(tools, stepsOf(steps));
  } catch (const std::runtime_error& error) {
    throw QueryError("displacements " + asked + " m: " + error.what());
  }
  solution.min_det_f = organ.body.minDetF(solution.state.u);
  return solution;
}

FieldErrors fieldErrors(std::span<const float> field, const FullSolution& truth, const Organ& organ,
                        double length) {
  double largest = 0.0, error2 = 0.0, truth2 = 0.0;
  for (std::size_t i = 0; i < organ.surface.nodes.size(); ++i) {
    const Vec3 u = Eigen::Map<const Eigen::Vector3f>(field.data() + 3 * i).cast<double>();
    const Vec3 u_full = truth.displacement(organ, static_cast<int>(i));
    largest = std::max(largest, (u - u_full).norm());
    error2 += organ.surface.areas[i] * (u - u_full).squaredNorm();
    truth2 += organ.surface.areas[i] * u_full.squaredNorm();
  }
  return {ratio(largest, length), std::sqrt(ratio(error2, truth2))};
}

double relativeError(const Vec3& v, const Vec3& v_newton) {
  return ratio((v - v_newton).norm(), v_newton.norm());
}

Errors errorsOf(const Answer& answer, const FullSolution& truth, const Organ& organ) {
  const FieldErrors field = fieldErrors(answer.field, truth, organ, truth.d.norm());
  return {relativeError(answer.response.force, truth.state.force),
          relativeError(answer.response.displacement, truth.d), field.max, field.l2};
}

}  // namespace palpate::query
