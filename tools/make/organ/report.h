// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "tools/mesh/statistics.h"
#include "tools/mesh/tet_mesh.h"
#include "tools/program/json.h"

namespace palpate::organ {

/// A region of the organ.
struct RegionReport {
  std::size_t tetrahedra;
  double volume;            ///< m^3
  Eigen::Vector3d centre;   ///< of its volume, m
  Eigen::Vector3d surface;  ///< the organ's surface node nearest to it, m
};

/// What palpate-organ tells about the organ it wrote.
struct Report {
  std::string file;
  mesh::MeshStatistics statistics;
  int element_order{1};
  std::size_t fixed_nodes{0};
  std::size_t accessible_nodes{0};
  std::map<std::string, RegionReport> regions;
  std::vector<std::string> notes;
};

/// @param notes  what its user should know
[[nodiscard]] Report makeReport(const std::string& file, const mesh::TetMesh& mesh,
                                const mesh::BoundarySurface& boundary, std::vector<std::string> notes);

[[nodiscard]] program::Json toJson(const Report& report);
void print(std::ostream& out, const Report& report);

}  // namespace palpate::organ
