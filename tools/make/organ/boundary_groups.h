// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "tools/mesh/tet_mesh.h"

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

/// Sets the groups `fixed` (by the rule) and `accessible`, and drops all others; regions stay. Accessible are the surface nodes
/// that are not fixed; where the file has a group `accessible`, only those in it. By height and by box only
/// surface nodes are fixed.
/// @throw MeshError when the group is unknown, what would be fixed does not hold the organ (mesh::checkHeld()),
///        or no node would be accessible
void setBoundaryGroups(mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, const FixedRule& rule);

/// The groups that setBoundaryGroups() will drop or replace: all but `accessible`, what the rule fixes, regions
/// and the whole `organ`. In ascending order.
[[nodiscard]] std::vector<std::string> groupsNotKept(const mesh::TetMesh& mesh, const FixedRule& rule);

}  // namespace palpate::organ
