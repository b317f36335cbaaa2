// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace palpate::mesh {

/// Edge lengths of the tetrahedra that fill an organ, m:
///   size(x) = min(inner, surface + growth * distance of x to the surface)
/// Small where a tool presses, larger where displacements vary little (docs/decisions/default_organ.md).
struct ElementSizes {
  double surface{0};   ///< of the triangles of the surface; 0 keeps those there are
  double inner{0};     ///< at most inside; 0: as on the surface
  double growth{0.5};  ///< per distance, in (0, 2]

  [[nodiscard]] bool isGraded() const noexcept { return inner > 0; }
};

/// @throw MeshError naming the first option that is out of range: --element-size, --inner-size (at least the size
///        at the surface), --growth
void checkElementSizes(const ElementSizes& sizes);

/// The graded sizes inside a surface whose triangles are there.
///   size(x) = min(inner, min over nodes i of (mean length of the edges at i + growth * |x - X_i|))
class InnerSizes {
 public:
  /// @param nodes, triangles  of the surface; nodes in no triangle do not count
  InnerSizes(const std::vector<Eigen::Vector3d>& nodes,
             const std::vector<std::array<std::int32_t, 3>>& triangles, const ElementSizes& sizes);

  /// Cost: nodes within (inner - smallest size at the surface) / growth.
  [[nodiscard]] double at(const Eigen::Vector3d& x) const;

 private:
  struct Source {
    Eigen::Vector3d place;
    double size;
  };
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] Cell cellOf(const Eigen::Vector3d& x) const;

  std::map<Cell, std::vector<Source>> cells_;
  double inner_, growth_;
  double reach_{0};  // of a source, m; the width of cells
};

}  // namespace palpate::mesh
