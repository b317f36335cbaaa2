// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/patch.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/base/index.h"

namespace palpate::solver {

namespace {

std::vector<Vec3> positionsOf(const FeModel& model, const std::vector<std::int32_t>& nodes) {
  std::vector<Vec3> positions;
  for (const std::int32_t node : nodes) positions.push_back(model.nodes()[index(node)]);
  return positions;
}

std::span<const double> numbers(const std::vector<Vec3>& points) {
  return {points.empty() ? nullptr : points.front().data(), 3 * points.size()};
}

std::span<const std::int32_t> numbers(const std::vector<std::array<std::int32_t, 3>>& triangles) {
  return {triangles.empty() ? nullptr : triangles.front().data(), 3 * triangles.size()};
}

}  // namespace

PatchSurface::PatchSurface(const FeModel& model, std::vector<std::int32_t> surface_nodes,
                           std::vector<std::array<std::int32_t, 3>> surface_triangles,
                           std::vector<std::array<std::int32_t, 3>> element_faces)
    : nodes(std::move(surface_nodes)),
      triangles(std::move(surface_triangles)),
      faces(element_faces.empty() ? triangles : std::move(element_faces)),
      positions(positionsOf(model, nodes)),
      graph(numbers(positions), numbers(triangles), numbers(faces)),
      areas(graph.lumpedAreas()) {}

Vec3 PatchSurface::position(const ContactPoint& s) const {
  Vec3 x = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) x += s.barycentric[k] * positions[index(faces[index(s.triangle)][k])];
  return x;
}

std::vector<bool> PatchSurface::corners() const {
  std::vector<bool> corner(nodes.size(), false);
  for (const auto& face : faces)
    for (const std::int32_t node : face) corner[index(node)] = true;
  return corner;
}

double PatchSurface::medianEdge() const {
  std::vector<double> lengths;
  for (const auto& t : faces)
    for (std::size_t k = 0; k < 3; ++k)
      lengths.push_back((positions[index(t[k])] - positions[index(t[(k + 1) % 3])]).norm());
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

std::vector<std::uint8_t> freeNodes(const FeModel& model, const PatchSurface& surface) {
  std::vector<std::uint8_t> free;
  for (const std::int32_t node : surface.nodes) free.push_back(model.isFree(node) ? 1 : 0);
  return free;
}

Patch patchOf(const PatchSurface& surface, const PatchNodes& nodes) {
  Patch patch;
  for (std::size_t i = 0; i < nodes.count; ++i) patch.nodes.push_back(surface.nodes[index(nodes.node[i])]);
  patch.weights.assign(nodes.weight.begin(), nodes.weight.begin() + static_cast<std::ptrdiff_t>(nodes.count));
  patch.free_share = nodes.free_share;
  return patch;
}

Patch makePatch(const FeModel& model, const PatchSurface& surface, const ContactPoint& s, double a) {
  const ContactPatches patches(surface.graph, freeNodes(model, surface), a, surface.graph.face(s.triangle));
  PatchNodes nodes = patches.room();
  patches.at(s, false, nodes);
  return patchOf(surface, nodes);
}

}  // namespace palpate::solver
