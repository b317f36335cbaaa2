// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "palpate/core/meta_model.h"
#include "palpate/core/response.h"

namespace palpate::query {

/// The contact position s, and the surface node that lies nearest to it.
struct Anchor {
  ContactPoint s;
  Vec3 position = Vec3::Zero();  ///< X(s), m
  int node{0};                   ///< surface node, 0-based
};

/// What the model answers, from the code that the server runs.
struct Answer {
  ResponseStatus status{ResponseStatus::kNoAnswer};
  Response response;
  std::vector<float> field;  ///< u, [Ns][3], m; zero when not accessible
};

/// s on a node. @param number  the node's number in the mesh file
/// @throw QueryError naming the node, when it is not on the surface or has no contact position
[[nodiscard]] Anchor anchorAtNode(const MetaModel& model, std::int64_t number);

/// s as the nearest point of the rest surface. @param c  m, finite
[[nodiscard]] Anchor anchorNear(const MetaModel& model, const Vec3& c);

/// f(s, d), df/dd and u(X; s, d) without release, friction and limiter                     DESIGN 2.2, 2.3
/// kNoAnswer where the server does not answer either: no node of the triangle is accessible.
/// @param d  m, clamped to the domain like in the server
[[nodiscard]] Answer ask(const MetaModel& model, const Anchor& anchor, const Vec3& d);

}  // namespace palpate::query
