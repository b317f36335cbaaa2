// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/read_msh4.h"

#include <cstdlib>
#include <limits>
#include <string>

namespace palpate::mesh {
namespace {

std::size_t count(ByteReader& in, std::size_t bytes_each, const char* what) {
  const auto number = in.integer64(what);
  return in.checkedCount(number, bytes_each, what);
}

constexpr std::int64_t kLargestGroup = std::numeric_limits<std::int32_t>::max();

struct Block {
  std::int64_t dimension, entity, extra;  ///< extra: parametric flag of nodes, type of elements
  std::size_t size;
};

Block readBlock(ByteReader& in, const MshFormat& format, const char* what) {
  Block block{};
  block.dimension = in.integer32("a block's dimension");
  block.entity = in.integer32("a block's entity");
  if (format.minor == 0) std::swap(block.dimension, block.entity);
  block.extra = in.integer32(what);
  block.size = count(in, 2, "the size of a block");
  if (block.dimension < 0 || block.dimension > 3)
    in.fail("a block's dimension is " + std::to_string(block.dimension));
  return block;
}

void readPoint(ByteReader& in, RawMesh& mesh, int parameters) {
  auto& x = mesh.points.emplace_back();
  for (Eigen::Index k = 0; k < 3; ++k) x[k] = in.real("a node's coordinate");
  for (int k = 0; k < parameters; ++k) in.real("a node's parameter");
}

// Each element of an entity is listed in all groups of it: many of both would fill the memory.
void readGroups(ByteReader& in, std::vector<std::int64_t>& groups) {
  constexpr std::size_t kMost = 16;  // ours: Gmsh states none
  const std::size_t more = count(in, 2, "an entity's number of physical groups");
  if (more + groups.size() > kMost)
    in.fail("an entity is in " + std::to_string(more + groups.size()) +
            " physical groups, expected at most " + std::to_string(kMost));
  for (std::size_t k = 0; k < more; ++k) {
    const std::int64_t group = in.integer32("an entity's physical group");
    if (group < -kLargestGroup || group > kLargestGroup)
      in.fail("an entity's physical group is " + std::to_string(group));
    groups.push_back(std::abs(group));  // the sign is an orientation
  }
}

}  // namespace

void readMsh4Entities(ByteReader& in, const MshFormat& format, MshEntities& entities) {
  std::size_t counts[4];
  for (auto& number : counts) number = count(in, 10, "the number of entities");
  for (int dimension = 0; dimension < 4; ++dimension) {
    const int box = dimension == 0 && format.minor == 1 ? 3 : 6;
    for (std::size_t i = 0; i < counts[dimension]; ++i) {
      const auto tag = in.integer32("an entity's number");
      for (int k = 0; k < box; ++k) in.real("an entity's bounding box");
      readGroups(in, entities[{dimension, tag}]);
      if (dimension == 0) continue;
      const auto sides = count(in, 2, "an entity's number of bounding entities");
      for (std::size_t k = 0; k < sides; ++k) in.integer32("an entity's bounding entity");
    }
  }
}

void readMsh4Nodes(ByteReader& in, const MshFormat& format, RawMesh& mesh) {
  const auto blocks = count(in, 8, "the number of node blocks");
  const auto nodes = count(in, 8, "the number of nodes");
  for (int k = 0; k < 2 * format.minor; ++k) in.integer64("the range of node numbers");
  for (std::size_t b = 0; b < blocks; ++b) {
    const Block block = readBlock(in, format, "a block's parametric flag");
    const int parameters = block.extra != 0 ? static_cast<int>(block.dimension) : 0;
    if (format.minor == 1) {
      for (std::size_t i = 0; i < block.size; ++i) mesh.point_tags.push_back(in.integer64("a node's number"));
    }
    for (std::size_t i = 0; i < block.size; ++i) {
      if (format.minor == 0) mesh.point_tags.push_back(in.integer32("a node's number"));
      readPoint(in, mesh, parameters);
    }
  }
  if (mesh.points.size() != nodes) {
    in.fail("the node blocks hold " + std::to_string(mesh.points.size()) + " nodes, the section announces " +
            std::to_string(nodes));
  }
}

void readMsh4Elements(ByteReader& in, const MshFormat& format, const MshEntities& entities, RawMesh& mesh) {
  const auto blocks = count(in, 8, "the number of element blocks");
  const auto announced = count(in, 4, "the number of elements");
  const bool wide = format.minor == 1;
  std::size_t found = 0;
  for (int k = 0; k < 2 * format.minor; ++k) in.integer64("the range of element numbers");
  for (std::size_t b = 0; b < blocks; ++b) {
    const Block block = readBlock(in, format, "a block's element type");
    const auto entity = entities.find({block.dimension, block.entity});
    const auto groups = entity == entities.end() ? std::vector<std::int64_t>{} : entity->second;
    for (std::size_t i = 0; i < block.size; ++i, ++found) {
      const auto tag = wide ? in.integer64("an element's number") : in.integer32("an element's number");
      readMshElement(in, mesh, wide, tag, mshElementType(in, block.extra, tag), groups);
    }
  }
  if (found != announced) {
    in.fail("the element blocks hold " + std::to_string(found) + " elements, the section announces " +
            std::to_string(announced));
  }
}

}  // namespace palpate::mesh
