// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace palpate::organ {

/// A piece with an open rim that hangs on nothing.
struct LoosePiece {
  std::size_t triangles;
  double area;                   ///< m^2
  std::array<double, 3> middle;  ///< of its bounding box, m
};

/// What repairSurface() changed.
struct Repairs {
  std::size_t not_finite{0};        ///< triangles left out because a coordinate is not finite
  std::size_t merged{0};            ///< vertices that became one with a neighbour
  std::size_t twins{0};             ///< triangles left out because they were there already
  std::size_t flat{0};              ///< triangles without area, left out
  std::size_t turned_over{0};       ///< triangles
  std::size_t stitched{0};          ///< edges that lay side by side and became one
  std::vector<LoosePiece> loose;    ///< pieces that were left out, the largest first
  std::size_t crossing_pairs{0};    ///< pairs of triangles that crossed
  std::size_t crossing_removed{0};  ///< triangles taken away where they crossed
  std::size_t holes{0};             ///< holes of the file that were filled
  std::size_t fills{0};      ///< triangles that fill holes, and what was taken away where triangles crossed
  double volume_of_file{0};  ///< mesh::enclosedVolume() as the file's triangles face, m^3
  double volume_before{0};   ///< once all triangles face outward, m^3
  double volume_after{0};    ///< m^3

  /// One line for each kind of change, then the volumes: what palpate-organ tells.
  [[nodiscard]] std::vector<std::string> inWords() const;
};

}  // namespace palpate::organ
