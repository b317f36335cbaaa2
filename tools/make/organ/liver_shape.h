// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::organ {

/// One section of the liver across x: control points of a closed cubic B-spline, which begins at the back, runs
/// forward along the under-side, around the inferior edge and back over the dome.
struct LiverSection {
  double x;                             ///< m
  std::vector<Eigen::Vector2d> points;  ///< (y, z), m
};

/// The sections of the liver from right to left, at most 14 mm apart. x points to the organ's left, y to the back, z up.
///   Wedges in both lobes: a rounded back, a flat under-side, a thin edge in front and below. The right lobe is
///   thick, the left one flat and higher. Two notches in the edge part them: that of the gall bladder and, with a
///   shallow groove above it, that of the falciform ligament.
[[nodiscard]] std::vector<LiverSection> liverSections();

}  // namespace palpate::organ
