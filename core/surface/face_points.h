// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/contact_point.h"

namespace palpate {

// A face may be divided into four: at its corners, in their order, and the one between, whose node k is the middle of the edge
// across from corner k. Face f has the triangles 4 f to 4 f + 3. So are the faces of quadratic elements, all in one plane
// (docs/design.md, Elements), and the rounded surface, level by level (ContactSurface).

/// The point of the face that a point of one of its triangles is. Real-time: yes.
[[nodiscard]] inline ContactPoint faceOf(const ContactPoint& part) noexcept PALPATE_NONBLOCKING {
  const auto child = static_cast<std::size_t>(part.triangle % 4);
  const std::array<double, 3>& w = part.barycentric;
  ContactPoint s{part.triangle / 4, {}};
  for (std::size_t k = 0; k < 3; ++k)
    s.barycentric[k] = child == 3 ? 0.5 * (1.0 - w[k]) : 0.5 * w[k] + (k == child ? 0.5 : 0.0);
  return s;
}

/// The triangle of a face that a point of it lies in, and where. Real-time: yes.
[[nodiscard]] inline ContactPoint partOf(const ContactPoint& s) noexcept PALPATE_NONBLOCKING {
  const std::array<double, 3>& w = s.barycentric;
  std::size_t child = 3;
  for (std::size_t k = 0; k < 3; ++k)
    if (w[k] >= 0.5) child = k;
  ContactPoint part{4 * s.triangle + static_cast<std::int32_t>(child), {}};
  for (std::size_t k = 0; k < 3; ++k)
    part.barycentric[k] = child == 3 ? 1.0 - 2.0 * w[k] : 2.0 * w[k] - (k == child ? 1.0 : 0.0);
  return part;
}

}  // namespace palpate
