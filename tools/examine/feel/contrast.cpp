// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/contrast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/index.h"
#include "core/response/patch_response.h"
#include "tools/program/printed.h"

namespace palpate::feel {

namespace {

using program::printed;

/// The number of the first entry in which two lists differ; none where they are the same.
template <class T>
std::optional<std::size_t> firstDifference(std::span<const T> a, std::span<const T> b) {
  const auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  if (in_a == a.end() && in_b == b.end()) return std::nullopt;
  return static_cast<std::size_t>(in_a - a.begin());
}

Vec3 positionOf(const ModelView& view, std::size_t node) {
  return Eigen::Map<const Vec3>(view.surface_positions.data() + 3 * node);
}

std::string placeOf(const ModelView& view, std::size_t node) {
  const Vec3 X = positionOf(view, node);
  return printed("%.9g %.9g %.9g m", X.x(), X.y(), X.z());
}

void checkNodes(const ModelView& a, const ModelView& b) {
  if (a.surfaceNodes() != b.surfaceNodes())
    throw ModelsDiffer(
        printed("the surfaces differ: %zu nodes, without %zu", a.surfaceNodes(), b.surfaceNodes()));
  const auto at = firstDifference(a.surface_positions, b.surface_positions);
  if (!at) return;
  const std::size_t node = *at / 3;
  throw ModelsDiffer(printed("the surfaces differ: node %lld of the mesh is at ",
                             static_cast<long long>(a.surface_mesh_tag[node])) +
                     placeOf(a, node) + ", without at " + placeOf(b, node));
}

/// The normal force, N; none where there is none or it does not push back.
std::optional<double> normalForce(const MetaModel& model, const ContactPoint& s, double depth, bool& beyond) {
  const Vec3 n = model.surface().normal(s);
  Response response;
  const ResponseStatus status = respond(model, s, -depth * n, response);
  beyond = beyond || status == ResponseStatus::kBeyond;
  const double force = -n.dot(response.force);
  if (status == ResponseStatus::kNoAnswer || !std::isfinite(force) || force <= 0.0) return std::nullopt;
  return force;
}

/// [Ns] m^2
std::vector<double> areas(const ModelView& view) {
  std::vector<double> area(view.surfaceNodes(), 0.0);
  for (std::size_t t = 0; t < view.triangles(); ++t) {
    const auto node = [&](std::size_t k) { return index(view.surface_triangles[3 * t + k]); };
    const Vec3 a = positionOf(view, node(0)), b = positionOf(view, node(1)), c = positionOf(view, node(2));
    for (std::size_t k = 0; k < 3; ++k) area[node(k)] += (b - a).cross(c - a).norm() / 6.0;
  }
  return area;
}

}  // namespace

std::size_t ContrastField::places() const {
  return static_cast<std::size_t>(
      std::count_if(presses.begin(), presses.end(), [](const auto& press) { return press.has_value(); }));
}

std::size_t ContrastField::beyond() const {
  return static_cast<std::size_t>(std::count_if(presses.begin(), presses.end(),
                                                [](const auto& press) { return press && press->beyond; }));
}

void checkComparable(const Pair& pair) {
  const ModelView &a = pair.model.view(), &b = pair.without.view();
  checkNodes(a, b);
  if (const auto at = firstDifference(a.surface_triangles, b.surface_triangles))
    throw ModelsDiffer(printed("the surfaces differ from triangle %zu on", *at / 3));
  if (const auto at = firstDifference(a.position_of_node, b.position_of_node))
    throw ModelsDiffer(printed("node %lld of the mesh has a contact position in one of the models only",
                               static_cast<long long>(a.surface_mesh_tag[*at])));
  if (const auto at = firstDifference(a.contact_accessible, b.contact_accessible))
    throw ModelsDiffer(printed("node %lld of the mesh is accessible in one of the models only",
                               static_cast<long long>(a.surface_mesh_tag[index(a.contact_node[*at])])));
  const double radius = pair.model.attributes().patch_radius;
  const double without = pair.without.attributes().patch_radius;
  if (radius != without)
    throw ModelsDiffer(
        printed("the patches differ: their radius is %.9g m, without %.9g m", radius, without));
}

std::optional<Press> pressAt(const Pair& pair, const ContactPoint& s, double depth) {
  bool beyond = false;
  const auto force = normalForce(pair.model, s, depth, beyond);
  const auto without = normalForce(pair.without, s, depth, beyond);
  if (!force || !without) return std::nullopt;
  return Press{*force, *without, beyond};
}

ContrastField contrastField(const Pair& pair, double depth) {
  const std::vector<std::uint8_t> accessible = pair.model.accessibleNodes();
  ContrastField field{std::vector<std::optional<Press>>(accessible.size()), areas(pair.model.view()), 0};
  for (std::size_t node = 0; node < accessible.size(); ++node) {
    if (accessible[node] == 0) continue;
    field.presses[node] = pressAt(pair, pair.model.surface().atNode(static_cast<int>(node)), depth);
    if (!field.presses[node]) ++field.unanswered;
  }
  return field;
}

std::size_t largest(const ContrastField& field) {
  if (field.places() == 0) throw ModelsDiffer("no accessible place of the organs pushes back");
  const auto contrastOf = [](const std::optional<Press>& press) {
    return press ? press->contrast() : -std::numeric_limits<double>::infinity();
  };
  return static_cast<std::size_t>(
      std::max_element(field.presses.begin(), field.presses.end(),
                       [&](const auto& a, const auto& b) { return contrastOf(a) < contrastOf(b); }) -
      field.presses.begin());
}

std::vector<Ring> ringsRound(const MetaModel& model, const ContrastField& field, std::size_t node) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::array kEdges{0.0, 0.005, 0.015, 0.025, 0.035, 0.045, kInfinity};  // m
  const Vec3 centre = positionOf(model.view(), node);
  std::vector<Ring> rings;
  for (std::size_t r = 0; r + 1 < kEdges.size(); ++r) {
    Ring ring{kEdges[r], kEdges[r + 1], 0, 0.0, kInfinity, -kInfinity};
    double area = 0.0;
    for (std::size_t i = 0; i < field.presses.size(); ++i) {
      const double distance = (positionOf(model.view(), i) - centre).norm();
      if (!field.presses[i] || distance < ring.from || distance >= ring.to) continue;
      const double contrast = field.presses[i]->contrast();
      ++ring.places;
      area += field.area[i];
      ring.mean += contrast * field.area[i];
      ring.min = std::min(ring.min, contrast);
      ring.max = std::max(ring.max, contrast);
    }
    if (ring.places > 0) ring.mean /= area;
    rings.push_back(ring);
  }
  return rings;
}

double shareAbove(const ContrastField& field, double level) {
  double all = 0.0, above = 0.0;
  for (std::size_t i = 0; i < field.presses.size(); ++i) {
    if (!field.presses[i]) continue;
    all += field.area[i];
    if (field.presses[i]->contrast() > level) above += field.area[i];
  }
  return all > 0.0 ? above / all : 0.0;
}

std::vector<RegionContrast> regionContrasts(const Pair& pair, double depth) {
  const ModelView& view = pair.model.view();
  std::vector<RegionSurface> surfaces = regionSurfaces(view);
  std::vector<RegionContrast> regions;
  for (std::size_t r = 0; r < surfaces.size(); ++r) {
    const std::string name(textOf(view.region_name[r]));
    if (surfaces[r].tetrahedra == 0 || name == "elsewhere") continue;
    const NearestPoint above = pair.model.surface().closestPoint(surfaces[r].centre);
    regions.push_back({name, std::move(surfaces[r]), above.position, pressAt(pair, above.s, depth)});
  }
  return regions;
}

}  // namespace palpate::feel
