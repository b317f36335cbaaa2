// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/make/organ/repair/repairs.h"
#include "tools/mesh/triangle_surface.h"

namespace palpate::organ {

/// Vertices nearer to each other than this part of the body's diagonal become one.
constexpr double kMergeDistance = 1e-6;

/// Merges vertices nearer than kMergeDistance of the body's diagonal, and leaves out triangles that are not finite,
/// lose a corner by that, or are there twice; and vertices without triangles. Counts them.
/// @throw MeshError when nothing is left
[[nodiscard]] mesh::TriangleSurface cleaned(const mesh::TriangleSurface& surface, Repairs& repairs);

}  // namespace palpate::organ
