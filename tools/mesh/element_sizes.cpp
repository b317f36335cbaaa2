// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/element_sizes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tools/mesh/mesh_error.h"

namespace palpate::mesh {

void checkElementSizes(const ElementSizes& sizes) {
  if (!(sizes.surface >= 0) || !std::isfinite(sizes.surface))
    throw MeshError("--element-size must be a positive number");
  if (!(sizes.inner == 0 || sizes.inner >= sizes.surface) || sizes.inner < 0 || !std::isfinite(sizes.inner)) {
    throw MeshError("--inner-size must be at least --element-size, " + std::to_string(sizes.surface) +
                    " m, not " + std::to_string(sizes.inner));
  }
  if (!(sizes.growth > 0 && sizes.growth <= 2)) {
    throw MeshError("--growth must be above 0 and at most 2, not " + std::to_string(sizes.growth));
  }
}

InnerSizes::InnerSizes(const std::vector<Eigen::Vector3d>& nodes,
                       const std::vector<std::array<std::int32_t, 3>>& triangles, const ElementSizes& sizes)
    : inner_(sizes.inner), growth_(sizes.growth) {
  std::vector<double> length(nodes.size(), 0);
  std::vector<int> edges(nodes.size(), 0);
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<std::size_t>(t[k]), b = static_cast<std::size_t>(t[(k + 1) % 3]);
      for (const std::size_t end : {a, b}) {
        length[end] += (nodes[a] - nodes[b]).norm();
        ++edges[end];
      }
    }
  std::vector<Source> sources;
  double smallest = inner_;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (edges[i] == 0) continue;
    sources.push_back({nodes[i], length[i] / edges[i]});
    smallest = std::min(smallest, sources.back().size);
  }
  // Even on coarse surfaces cells are no points.
  reach_ = std::max(inner_ - smallest, 0.1 * inner_) / growth_;
  for (const Source& source : sources) cells_[cellOf(source.place)].push_back(source);
}

double InnerSizes::at(const Eigen::Vector3d& x) const {
  double size = inner_;
  const Cell centre = cellOf(x);
  for (std::int64_t i = centre[0] - 1; i <= centre[0] + 1; ++i)
    for (std::int64_t j = centre[1] - 1; j <= centre[1] + 1; ++j)
      for (std::int64_t k = centre[2] - 1; k <= centre[2] + 1; ++k) {
        const auto cell = cells_.find({i, j, k});
        if (cell == cells_.end()) continue;
        for (const Source& source : cell->second)
          size = std::min(size, source.size + growth_ * (x - source.place).norm());
      }
  return size;
}

InnerSizes::Cell InnerSizes::cellOf(const Eigen::Vector3d& x) const {
  Cell cell{};
  for (std::size_t k = 0; k < 3; ++k)
    cell[k] = static_cast<std::int64_t>(std::floor(x[static_cast<Eigen::Index>(k)] / reach_));
  return cell;
}

}  // namespace palpate::mesh
