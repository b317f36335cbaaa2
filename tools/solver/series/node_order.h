// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/solver/fem/cholesky.h"
#include "tools/solver/fem/fe_model.h"

namespace palpate::solver {

/// A row of the factor: component c of a node, by its place.
struct NodeRow {
  std::size_t place;
  std::size_t c;
};

/// Where a node's numbers lie: in the order of the factor, clamped nodes last. It follows nested dissection, so
/// neighbours in memory are neighbours in the mesh.
struct NodeOrder {
  NodeOrder(const FeModel& model, const Cholesky& factor);
  /// The points with places instead of nodes, sorted by law and by them: each field is read once for each law, not once per element.
  [[nodiscard]] FeModel::Points sorted(const FeModel::Points& of_the_mesh) const;
  [[nodiscard]] std::size_t placeOf(int node) const {
    return static_cast<std::size_t>(place[static_cast<std::size_t>(node)]);
  }
  /// The row of the factor for a component of a free node.
  [[nodiscard]] std::size_t rowOf(int node, int c) const {
    return row_of[placeOf(node)][static_cast<std::size_t>(c)];
  }

  std::vector<NodeRow> rows;
  std::vector<std::int32_t> place;                 ///< by node
  std::vector<std::array<std::size_t, 3>> row_of;  ///< by place, of free nodes
};

/// A power of two of the order of an element's edge, m: a change of unit by it is exact.
[[nodiscard]] double pointLength(const FeModel::Points& points);

}  // namespace palpate::solver
