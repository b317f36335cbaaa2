// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/make/organ/repair/cgal_mesh.h"
#include "tools/make/organ/repair/repairs.h"

namespace palpate::organ {

/// The rim around crossing triangles that are taken away spans at most this part of the body's diagonal.
constexpr double kLargestWound = 0.5;
/// A piece with an open rim is left out when its area is at most this part of the whole.
constexpr double kLoosePiece = 0.05;

/// Fills all holes. @return how many
/// @param largest      part of the diagonal that a hole may span
/// @param[out] fills   triangles, added
/// @throw MeshError where a hole is larger, with its place and size
std::size_t fillHoles(Mesh& mesh, double diagonal, double largest, std::size_t& fills);

/// Leaves out pieces with a rim that are small beside the whole. @return them, the largest first
std::vector<LoosePiece> leaveOutLoosePieces(Mesh& mesh);

/// Takes triangles without area out of a mesh, and needles and caps that nearly are. @return how many
std::size_t mendFlatTriangles(Mesh& mesh);

/// What mendCrossings() changed.
struct Mended {
  std::size_t removed{0}, fills{0};  ///< triangles
};

/// Takes triangles that cross, with those around them, out of a closed mesh, and fills the holes; what crosses then,
/// with wider rings.
/// @param diagonal  of the body, m
/// @param least_fold  also triangles that meet at an edge at less than this angle, degrees; 0: they stay
/// @throw MeshError when some cross in the end
[[nodiscard]] Mended mendCrossings(Mesh& mesh, double diagonal, double least_fold = 0);

}  // namespace palpate::organ
