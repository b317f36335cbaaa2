// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "palpate/mesh/tet_mesh.h"

namespace palpate::organ {

/// Where an organ is held.
struct FixedRule {
  enum class Kind { kKeep, kGroup, kLowestZ, kBox };

  Kind kind{Kind::kKeep};   ///< kKeep: the group `fixed` of the file, if there is one
  std::string group;        ///< kGroup: its name
  double fraction{0};       ///< kLowestZ: of the surface nodes, in (0, 1)
  Eigen::AlignedBox3d box;  ///< kBox: m
};

/// Reads `group:NAME`, `lowest-z:FRACTION` or `box:x0,y0,z0,x1,y1,z1`.
/// @throw MeshError that quotes the text and says what is wrong with it
[[nodiscard]] FixedRule parseFixedRule(const std::string& text);

/// Sets the groups `fixed` (by the rule) and `accessible` (the other surface nodes), and drops all others. By
/// height and by box only surface nodes are fixed.
/// @throw MeshError when the group is unknown, fewer than three nodes or only nodes on one line would be
/// fixed, or
///        none would be accessible
void setBoundaryGroups(mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, const FixedRule& rule);

}  // namespace palpate::organ
