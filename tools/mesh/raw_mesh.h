// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// What the readers of all formats collect: the numbers of the file, complete.
struct RawMesh {
  using GroupId = std::pair<int, std::int64_t>;  ///< dimension, number

  struct Tetrahedron {
    std::int64_t tag;
    std::vector<std::int64_t> nodes;   ///< point tags: 4 corners, then 6 in the middle of kTetEdges or none
    std::vector<std::int64_t> groups;  ///< numbers of its groups of dimension 3
  };

  std::vector<Eigen::Vector3d> points;
  std::vector<std::int64_t> point_tags;
  std::vector<Tetrahedron> tetrahedra;
  std::map<GroupId, std::vector<std::int64_t>> groups;  ///< point tags, with repetitions
  std::map<GroupId, std::string> group_names;
};

/// Links tags to indices, drops points in no tetrahedron, names groups (see readMesh()).
/// @throw MeshError on repeated node numbers, references to missing nodes, tetrahedra of 4 and of 10 nodes
TetMesh assemble(const std::filesystem::path& path, const RawMesh& raw);

}  // namespace palpate::mesh
