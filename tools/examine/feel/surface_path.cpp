// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/surface_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/response/patch_response.h"
#include "core/response/response.h"
#include "core/surface/contact_surface.h"
#include "core/surface/surface_mesh.h"

namespace palpate::feel {

namespace {

PathPoint at(const MetaModel& model, const ContactPoint& s) {
  return {s, model.surface().position(s), model.surface().normal(s)};
}

PathPoint rounded(const MetaModel& model, const ContactPoint& fine) {
  const ContactSurface& surface = model.contactSurface();
  return {surface.rest(fine), surface.mesh().position(fine), surface.mesh().normal(fine)};
}

/// What lies straight below a tip that goes by v from `height` above a point. @return nothing beyond the border, and where
/// no tip gets so deep: in a hollow that is sharper than `height`
std::optional<PathPoint> below(const MetaModel& model, const PathPoint& from, double height, const Vec3& v) {
  const SurfaceMesh& surface = model.contactSurface().mesh();
  const double farthest = 20.0 * v.norm();
  ContactPoint fine = model.contactSurface().fine(from.s);
  double h = 0.0;
  if (!surface.project(from.position + height * from.normal + v, fine, h) ||
      !surface.reachable(fine.triangle))
    return std::nullopt;
  const PathPoint next = rounded(model, fine);
  if ((next.position - from.position).norm() > farthest) return std::nullopt;
  return next;
}

Vec3 tangential(const Vec3& v, const Vec3& n) {
  return (v - n * n.dot(v)).normalized();
}

double areaOf(const MetaModel& model, int triangle) {
  std::array<Vec3, 3> X;
  for (std::size_t k = 0; k < 3; ++k) {
    ContactPoint corner{triangle, {}};
    corner.barycentric[k] = 1.0;
    X[k] = model.surface().position(corner);
  }
  return 0.5 * (X[1] - X[0]).cross(X[2] - X[0]).norm();
}

}  // namespace

ContactPoint randomContact(const MetaModel& model, std::mt19937& random) {
  std::vector<double> area(static_cast<std::size_t>(model.surface().triangles()), 0.0);
  for (int t = 0; t < model.surface().triangles(); ++t)
    if (model.surface().reachable(t)) area[static_cast<std::size_t>(t)] = areaOf(model, t);
  std::discrete_distribution<int> triangle(area.begin(), area.end());
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double root = std::sqrt(uniform(random)), other = uniform(random);
  return {triangle(random), {1.0 - root, root * (1.0 - other), root * other}};
}

double normalStiffness(const MetaModel& model, const ContactPoint& s) {
  Response response;
  (void)respond(model, s, Vec3::Zero(), response);
  const Vec3 n = model.surface().normal(s);
  return n.dot(response.stiffness * n);
}

std::optional<std::vector<PathPoint>> randomPath(const MetaModel& model, double height, double step,
                                                 double length, std::mt19937& random) {
  constexpr double kSharpest = 60.0 * std::numbers::pi / 180.0 / 0.01;  // rad/m
  std::normal_distribution<double> gauss;
  std::vector<PathPoint> path{rounded(model, model.contactSurface().fine(randomContact(model, random)))};
  Vec3 heading = tangential(Vec3(gauss(random), gauss(random), gauss(random)), path.back().normal);
  double bend = 0.0;  // rad/m
  const auto count = static_cast<std::size_t>(length / step);
  while (path.size() <= count) {
    bend = std::clamp(0.98 * bend + 0.1 * kSharpest * gauss(random), -kSharpest, kSharpest);
    const Vec3 n = path.back().normal;
    heading = tangential(Eigen::AngleAxisd(bend * step, n) * heading, n);
    const auto next = below(model, path.back(), height, step * heading);
    if (!next) break;
    path.push_back(*next);
  }
  if (path.size() < count / 2) return std::nullopt;
  return path;
}

std::optional<std::vector<PathPoint>> pathBetween(const MetaModel& model, const ContactPoint& from,
                                                  const ContactPoint& to, double step) {
  ContactPoint s = from;
  std::vector<PathPoint> path{at(model, s)};
  const Vec3 end = model.surface().position(to);
  const auto most = static_cast<std::size_t>(3.0 * (end - path.back().position).norm() / step) + 2;
  while ((end - path.back().position).norm() > step) {
    const Vec3 heading = tangential(end - path.back().position, path.back().normal);
    if (path.size() > most || !model.surface().move(s, step * heading, Reach::kAccessible))
      return std::nullopt;
    path.push_back(at(model, s));
  }
  path.push_back(at(model, to));
  return path;
}

}  // namespace palpate::feel
