// SPDX-License-Identifier: Apache-2.0
#include "core/model/clamp_to_length.h"

#include "core/base/length.h"

namespace palpate {

Vec3 clampToLength(const Vec3& d, double radius) noexcept PALPATE_NONBLOCKING {
  const double length = lengthOf(d);  // |d|^2 of a huge d overflows
  return length > radius ? Vec3((radius / length) * d) : d;
}

Mat3 projectionGradient(const Vec3& d, double radius) noexcept PALPATE_NONBLOCKING {
  const Vec3 direction = d / lengthOf(d);
  return (radius / lengthOf(d)) * (Mat3::Identity() - direction * direction.transpose());
}

}  // namespace palpate
