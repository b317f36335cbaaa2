// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <random>
#include <vector>

#include "palpate/core/meta_model.h"

namespace palpate::feel {

/// A point of the surface and where the tip's centre is when it lies h above it, c = X + h n with the interpolated
/// normal n.
struct PathPoint {
  ContactPoint s;
  Vec3 position;  ///< X(s), m
  Vec3 normal;    ///< n(s)
};

/// A random point of the accessible part, with equal chances for equal areas.
[[nodiscard]] ContactPoint randomContact(const MetaModel& model, std::mt19937& random);

/// n . (df/dd) n at rest, N/m.
[[nodiscard]] double normalStiffness(const MetaModel& model, const ContactPoint& s);

/// A smooth random path over the accessible part: it begins at a random point and turns by at most 60 degrees
/// per cm.
/// @param[in] step distance between two points, m, @param[in] length  of the whole, m
/// @return nothing when the path met the border before half the length; otherwise the path up to the border
[[nodiscard]] std::optional<std::vector<PathPoint>> randomPath(const MetaModel& model, double step,
                                                               double length, std::mt19937& random);

/// The path over the surface from `from` to `to`, always in the direction of the straight line to `to`.
/// @return nothing when no such path over the accessible part is shorter than three times the distance
[[nodiscard]] std::optional<std::vector<PathPoint>> pathBetween(const MetaModel& model,
                                                                const ContactPoint& from,
                                                                const ContactPoint& to, double step);

}  // namespace palpate::feel
