// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

namespace palpate {

/// A contact position s: a material point of the rest surface (docs/design.md, Symbols).
struct ContactPoint {
  std::int32_t triangle{-1};            ///< 0-based into /contact/triangles; -1: none
  std::array<double, 3> barycentric{};  ///< weights of the triangle's nodes, >= 0, sum 1

  [[nodiscard]] bool operator==(const ContactPoint&) const noexcept = default;
};

/// s in terms of the positions that the model was computed at. Vertices without one are dropped and the
/// weights renormalized; count 0: the model has no answer at s.
struct PositionMix {
  int count{0};
  std::array<std::int32_t, 3> position{};  ///< 0-based contact positions, `count` of them
  std::array<double, 3> weight{};          ///< their weights, sum 1
};

static_assert(std::is_trivially_copyable_v<ContactPoint> && std::is_trivially_copyable_v<PositionMix>);

}  // namespace palpate
