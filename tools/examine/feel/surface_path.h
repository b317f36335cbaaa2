// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <random>
#include <vector>

#include "core/base/contact_point.h"
#include "core/model/meta_model.h"

namespace palpate::feel {

/// A point of a surface and where the tip's centre is when it lies h above it, c = X + h n with the interpolated
/// normal n.
struct PathPoint {
  ContactPoint s;  ///< of the rest surface
  Vec3 position;   ///< X(s), m
  Vec3 normal;     ///< n(s)
};

/// A random point of the accessible part, with equal chances for equal areas.
[[nodiscard]] ContactPoint randomContact(const MetaModel& model, std::mt19937& random);

/// n . (df/dd) n at rest, N/m.
[[nodiscard]] double normalStiffness(const MetaModel& model, const ContactPoint& s);

/// A smooth random path of a tip's centre that goes over the accessible part of the contact surface: it begins above a
/// random point and turns by at most 60 degrees per cm, beside what the surface turns.
/// @param[in] height  of the tip's centre above the points, m, @param[in] step  of the tip's centre from point to point, m,
///            @param[in] length  of the tip's way, m
/// @return nothing when the path met the border, or a hollow sharper than `height`, before half the length; otherwise the
///         path up to there
[[nodiscard]] std::optional<std::vector<PathPoint>> randomPath(const MetaModel& model, double height,
                                                               double step, double length,
                                                               std::mt19937& random);

/// The path over the rest surface from `from` to `to`, always in the direction of the straight line to `to`.
/// @return nothing when no such path over the accessible part is shorter than three times the distance
[[nodiscard]] std::optional<std::vector<PathPoint>> pathBetween(const MetaModel& model,
                                                                const ContactPoint& from,
                                                                const ContactPoint& to, double step);

}  // namespace palpate::feel
