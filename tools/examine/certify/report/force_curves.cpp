// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/force_curves.h"

#include <algorithm>
#include <optional>

#include "core/response/patch_response.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"

namespace palpate::certify {

namespace {

constexpr int kSteps = 40;  // of the drawn curve
constexpr int kSolved = 4;  // parts of the travel that are solved in full

Response answer(const MetaModel& model, const ForceCurve& curve, double depth) {
  Response response;
  (void)respond(model, curve.s, depth * curve.direction, response);  // it goes on beyond the domain
  return response;
}

void drawModel(const MetaModel& model, double travel, ForceCurve& curve) {
  for (int i = 0; i <= kSteps; ++i) {
    const Response response = answer(model, curve, travel * i / kSteps);
    curve.domain_radius = response.domain_radius;
    curve.depth.push_back(travel * i / kSteps);
    curve.force.push_back(response.force.dot(curve.direction));
  }
}

std::vector<double> depthsToSolve(double travel, std::optional<double> further) {
  std::vector<double> depths;
  for (int i = 1; i <= kSolved; ++i) depths.push_back(travel * i / kSolved);
  if (further && *further < travel) depths.push_back(*further);
  std::sort(depths.begin(), depths.end());
  return depths;
}

std::optional<ForceCurve> typical(const MetaModel& model, const SurfaceMaps& maps) {
  const auto node = maps.typicalNode(model);
  if (!node) return {};
  ForceCurve curve;
  curve.place = "typical";
  curve.s = model.surface().atNode(static_cast<int>(*node));
  curve.position = model.surface().position(curve.s);
  curve.direction = -model.surface().nodeNormal(static_cast<int>(*node));
  return curve;
}

/// @param[out] length  of its d, m
std::optional<ForceCurve> worst(const Examination& found, std::optional<double>& length) {
  const std::vector<Finding> within = found.of(Outcome::kWithin);
  if (within.empty()) return {};
  const Touch& touch = std::max_element(within.begin(), within.end(), [](const Finding& a, const Finding& b) {
                         return a.force_error < b.force_error;
                       })->touch;
  ForceCurve curve;
  curve.place = "worst";
  curve.s = touch.s;
  curve.position = touch.position;
  curve.direction = touch.d.normalized();
  length = touch.d.norm();
  return curve;
}

void solve(const MetaModel& model, ReferenceSolver& reference, const std::vector<double>& depths, int threads,
           ForceCurve& curve) {
  std::vector<Touch> touches;
  for (const double depth : depths) touches.push_back({curve.s, curve.position, depth * curve.direction});
  const std::vector<Eigen::VectorXd> starts = reference.starts(touches);
  std::vector<std::optional<ForceCurve::Solved>> solved(depths.size());
  solver::Progress progress("full solutions of a force curve", depths.size());
  solver::parallelFor(threads, depths.size(), [&](int thread, std::size_t i) {
    if (const auto truth = reference.solve(std::span(&touches[i], 1), starts[i], thread)) {
      const Vec3& f = truth->state.force;
      solved[i] = {depths[i], f.dot(curve.direction),
                   query::relativeError(answer(model, curve, depths[i]).force, f)};
    }
    progress.advance();
  });
  for (const auto& one : solved)
    if (one)
      curve.newton.push_back(*one);
    else
      ++curve.not_converged;
}

}  // namespace

std::vector<ForceCurve> forceCurves(const MetaModel& model, const query::Organ& organ,
                                    const Examination& found, const SurfaceMaps& maps, double travel,
                                    int threads) {
  ReferenceSolver reference(organ, model.attributes().patch_radius, threads);
  std::vector<ForceCurve> curves;
  std::optional<double> length;
  const auto add = [&](std::optional<ForceCurve> curve) {
    if (!curve) return;
    drawModel(model, travel, *curve);
    solve(model, reference, depthsToSolve(travel, length), threads, *curve);
    curves.push_back(*std::move(curve));
  };
  add(typical(model, maps));
  add(worst(found, length));
  return curves;
}

}  // namespace palpate::certify
