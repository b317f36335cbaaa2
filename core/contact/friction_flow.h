// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/types.h"

namespace palpate {

/// What holds a tip back that goes a way y, N: friction, and viscosity beyond the way that is free.
struct Holding {
  double friction{0.0};        ///< mu f_n at y = 0, N
  Vec2 growth = Vec2::Zero();  ///< d(mu f_n)/dy, N/m
  double drag{0.0};            ///< N/m, of what is beyond `free_way`
  double free_way{0.0};        ///< m
  [[nodiscard]] double at(const Vec2& y) const noexcept PALPATE_NONBLOCKING;
};

/// The way y of a tip in one tick, where friction opposes the way itself (implicit Euler of Coulomb's law):
///   T - A y = h(y) y / |y|,   h = max(0, mu f_n) + drag max(0, |y| - free_way);   y = 0 where |T| <= mu f_n
/// With |y| sigma = h that is (A + sigma) y = T, and sigma is found by Newton's method. Not: T scaled back to the cone, which is
/// the same only where A is as stiff in all directions.
/// @param[in] T  at y = 0, N, @param[in] A  symmetric, positive definite, N/m. Real-time: yes.
[[nodiscard]] Vec2 wayAgainst(const Holding& holding, const Vec2& T,
                              const Mat2& A) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
