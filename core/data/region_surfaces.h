// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/data/model_view.h"

namespace palpate {

/// Where a region of the volume mesh lies and where it ends inside the organ, at rest.
struct RegionSurface {
  std::size_t tetrahedra{0};             ///< of the region
  Vec3 centre = Vec3::Zero();            ///< of its volume, m; the origin where it has none
  std::vector<double> positions;         ///< [n][3] m
  std::vector<std::uint32_t> triangles;  ///< [t][3] of these nodes, counter-clockwise from outside the region
};

/// Surfaces of all regions, [R]. A face between two regions belongs to the smaller one, by volume: a nodule has the faces round
/// it, the tissue that it lies in has none, and none is there twice. Faces on the organ's own surface are left out. Of
/// quadratic elements the corners: their edges are straight.
/// @param view  checked; a face of more than two tetrahedra is left out
/// Cost O(V + B log B), B of the 4 V faces being near a border between regions. Real-time: no.
[[nodiscard]] std::vector<RegionSurface> regionSurfaces(const ModelView& view);

/// At most what regionSurfaces() takes and returns for each tetrahedron, bytes.
inline constexpr std::size_t kRegionSurfaceBytes = 256;

}  // namespace palpate
