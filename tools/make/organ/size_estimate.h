// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/mesh/element_sizes.h"

namespace palpate::organ {

/// A body that is to be filled.
struct Body {
  double volume;         ///< m^3
  double area;           ///< of its surface, m^2
  double shortest_side;  ///< of its bounding box, m
};

/// What filling a body takes, before it is filled.
struct SizeEstimate {
  double nodes, tetrahedra;  ///< nodes with those in the middle of edges, where elements are quadratic
  double bytes;              ///< of memory
  double seconds;

  /// "about 12000 nodes, 60000 tetrahedra; 1.8 s and 0.15 GB of memory to fill"
  [[nodiscard]] std::string inWords() const;
};

/// Estimates from volume and area, for a body as compact as its volume over its area says:
///   tetrahedra  integral of a / size(d)^3 dV + b area / size^2,  dV = area (1 - d area / 3 volume)^2 dd
/// The constants are fitted to what Gmsh makes (docs/decisions/import.md): nodes come within 40 % where the body is several
/// elements thick. A surface that keeps its triangles may have half as many.
/// @param sizes  with the size at the surface above 0  @param order  of the elements
[[nodiscard]] SizeEstimate estimate(const Body& body, const mesh::ElementSizes& sizes, int order);

/// The smallest size at the surface with which a body has at most so many nodes, m. Sizes inside grow along with it.
[[nodiscard]] double smallestSize(const Body& body, mesh::ElementSizes sizes, int order, double most_nodes);

}  // namespace palpate::organ
