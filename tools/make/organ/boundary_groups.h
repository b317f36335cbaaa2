// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/mesh/tet_mesh.h"

namespace palpate::organ {

/// Where an organ is held: one part of its outer surface.
struct FixedRule {
  enum class Kind { kGroup, kLowestZ, kBox, kSide, kNormal };

  Kind kind{Kind::kGroup};
  std::string text{};                                  ///< as it was given
  std::string group{};                                 ///< kGroup: its name in the file
  double fraction{0};                                  ///< kLowestZ: of the surface nodes, in (0, 1)
  Eigen::AlignedBox3d box{};                           ///< kBox: m
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();  ///< kSide, kNormal: unit
  double angle{0};  ///< kNormal: between a triangle's normal and this one at most, rad
};

/// Parts of the surface that are held together. None: the group `fixed` of the file, if there is one.
using FixedRules = std::vector<FixedRule>;

/// Reads `group:NAME`, `lowest-z:FRACTION`, `box:x0,y0,z0,x1,y1,z1`, a side (`-x`, `+z`, ...: the triangles that face
/// it more than any other side) or `normal:x,y,z[,degrees]` (the triangles that face this way within 30 degrees, or
/// those given).
/// @throw program::UsageError that quotes the text and says what is wrong with it
[[nodiscard]] FixedRule parseFixedRule(const std::string& text);

/// @param known  the groups that there are: nodes or triangles by name
/// @throw program::UsageError always, naming them
[[noreturn]] void refuseUnknownGroup(const std::string& name,
                                     const std::map<std::string, std::vector<std::int32_t>>& known);

/// The nodes that rules hold, ascending. Rules that speak of places take nodes of the outer surface, not those of
/// cavities.
/// @throw program::UsageError when a group is unknown: it names those there are
[[nodiscard]] std::vector<std::int32_t> fixedNodes(const mesh::TetMesh& mesh,
                                                   const mesh::BoundarySurface& boundary,
                                                   const FixedRules& rules);

/// Sets the groups `fixed` (by the rules) and `accessible`, and drops all others; regions stay. Accessible are the
/// nodes of the outer surface that are not fixed, for no tool comes into a cavity; where the file has a group
/// `accessible`, only those in it.
/// @throw program::UsageError when a group is unknown, what the rules fix does not hold the organ (mesh::checkHeld()), or
///        no node would be accessible; MeshError when the file's own groups are at fault
void setBoundaryGroups(mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, const FixedRules& rules);

/// The groups that setBoundaryGroups() will drop or replace: all but `accessible`, what the rules fix, regions
/// and the whole `organ`. In ascending order.
[[nodiscard]] std::vector<std::string> groupsNotKept(const mesh::TetMesh& mesh, const FixedRules& rules);

}  // namespace palpate::organ
