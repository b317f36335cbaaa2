// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/index.h"
#include "core/base/prefetch.h"
#include "core/base/types.h"
#include "core/data/model_view.h"
#include "core/model/smooth_cubic.h"
#include "core/surface/smooth_places.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

/// The stiffness of a contact patch at rest, K_s = C_s^-1: the file's values at contact positions and middles of edges, where
/// they are exact, and a C1 interpolant between them.                                     docs/design.md, Parts
/// Built before the loop, then const. Of a "displacement" model only.
class PatchStiffness {
 public:
  /// @throw std::invalid_argument when the file's stiffness has not as many places
  PatchStiffness(const ModelView& view, const ModelAttributes& attributes, const SmoothPlaces& places);

  struct Value {
    Mat3 K = Mat3::Zero();        ///< N/m, symmetric
    std::array<Mat3, 3> slope{};  ///< dK/dlambda, lambda the barycentric weights of s, N/m
  };
  /// In a triangle that is not complete K is mixed linearly, and its slope is zero. Cost O(1). Real-time: yes.
  void at(const SurfaceMesh& surface, const ContactPoint& s, Value& out) const noexcept PALPATE_NONBLOCKING;
  /// Asks the cache for what at() reads in a triangle. Real-time: yes.
  void expect(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING {
    const std::int32_t number = cubic_of_[index(triangle)];
    if (number >= 0) prefetch(cubics_[index(number)]);
  }

 private:
  std::span<const double> stiffness_;   // [places][6][4]
  std::vector<std::int32_t> cubic_of_;  // [T] or -1
  std::vector<SmoothCubic<6>> cubics_;  // of complete triangles
};

}  // namespace palpate
