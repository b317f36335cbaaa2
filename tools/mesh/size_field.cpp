// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/size_field.h"

#include <gmsh.h>

#include <unordered_map>

namespace palpate::mesh {

SizeField::SizeField(const std::function<double(int, int, const Eigen::Vector3d&)>& size) {
  // The field alone decides, inside volumes too.
  gmsh::option::setNumber("Mesh.MeshSizeFromPoints", 0);
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  gmsh::model::mesh::setSizeCallback([size](int dimension, int entity, double x, double y, double z) {
    return size(dimension, entity, {x, y, z});
  });
}

SizeField::~SizeField() {
  gmsh::model::mesh::removeSizeCallback();
}

InnerSizes innerSizesOfModel(const ElementSizes& sizes) {
  std::vector<std::size_t> tags, triangle_tags, corners;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  std::vector<Eigen::Vector3d> nodes;
  std::unordered_map<std::size_t, std::int32_t> index;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    index[tags[i]] = static_cast<std::int32_t>(i);
    nodes.emplace_back(coordinates.data() + 3 * i);
  }
  constexpr int kTriangle = 2;
  gmsh::model::mesh::getElementsByType(kTriangle, triangle_tags, corners);
  std::vector<std::array<std::int32_t, 3>> triangles;
  for (std::size_t c = 0; c + 2 < corners.size(); c += 3)
    triangles.push_back({index.at(corners[c]), index.at(corners[c + 1]), index.at(corners[c + 2])});
  return {nodes, triangles, sizes};
}

}  // namespace palpate::mesh
