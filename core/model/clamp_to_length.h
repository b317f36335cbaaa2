// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/types.h"

namespace palpate {

/// d, or d scaled to the length `radius`.
[[nodiscard]] Vec3 clampToLength(const Vec3& d, double radius) noexcept PALPATE_NONBLOCKING;

/// Derivative of d -> radius d / |d|, for |d| > 0.
[[nodiscard]] Mat3 projectionGradient(const Vec3& d, double radius) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
