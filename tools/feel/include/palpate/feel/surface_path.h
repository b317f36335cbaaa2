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

/// A smooth random way over the accessible part: it begins somewhere and turns slowly, at most 60 degrees a cm.
/// @param[in] step  way between two points, m, @param[in] length  of the whole, m
/// @return nothing when the border came before half the length; otherwise what was possible
[[nodiscard]] std::optional<std::vector<PathPoint>> randomPath(const MetaModel& model, double step,
                                                               double length, std::mt19937& random);

/// The way over the surface from `from` towards `to`, always in the direction of the straight line to it.
/// @return nothing when it cannot be reached over the accessible part within three times the distance
[[nodiscard]] std::optional<std::vector<PathPoint>> pathBetween(const MetaModel& model,
                                                                const ContactPoint& from,
                                                                const ContactPoint& to, double step);

}  // namespace palpate::feel
