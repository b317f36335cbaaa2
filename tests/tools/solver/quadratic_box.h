// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>
#include <vector>

#include "boxes.h"
#include "tools/mesh/quadratic.h"

namespace palpate::solver {

/// A box as a mesh of elements of ten nodes, clamped at x = 0.
[[nodiscard]] inline mesh::TetMesh quadraticMesh(const Box& box) {
  mesh::TetMesh linear;
  linear.nodes = box.nodes();
  for (std::size_t i = 0; i < linear.nodes.size(); ++i)
    linear.node_tags.push_back(static_cast<std::int64_t>(i) + 1);
  linear.tetrahedra = box.tetrahedra();
  linear.groups["fixed"] = box.face(0, false);
  return mesh::quadraticOf(linear);
}

[[nodiscard]] inline FeModel quadraticModel(const Box& box, const Material& material) {
  const mesh::TetMesh mesh = quadraticMesh(box);
  return FeModel(mesh.nodes, {mesh.tetrahedra, mesh.midsides}, mesh.groups.at("fixed"), material);
}

/// A box of elements of ten nodes, 4 Gauss points each, stiffer in every other element.
struct QuadraticBox {
  FeModel model;
  const std::vector<Vec3>& nodes{model.nodes()};
  const std::vector<IntegrationPoint<10>>& points{std::get<1>(model.points())};

  explicit QuadraticBox(const Box& box, const Law& law = {}) : model(quadraticModel(box, uneven(box, law))) {}
  QuadraticBox(const QuadraticBox&) = delete;
  QuadraticBox& operator=(const QuadraticBox&) = delete;
  ~QuadraticBox() = default;

  [[nodiscard]] Eigen::Index size() const { return 3 * static_cast<Eigen::Index>(nodes.size()); }

 private:
  static Material uneven(const Box& box, const Law& law) {
    Material material{{160e3, 0.45}};
    material.regions = {{"even", {160e3, 0.45}, law}, {"odd", {480e3, 0.3}, law}};
    for (std::size_t e = 0; e < box.tetrahedra().size(); ++e)
      material.region_of_element.push_back(static_cast<std::int32_t>(e % 2));
    return material;
  }
};

}  // namespace palpate::solver
