// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/contact_point.h"
#include "core/data/model_view.h"
#include "core/model/meta_model.h"
#include "core/response/response.h"

namespace palpate::query {

/// The contact position s, and the surface node that lies nearest to it.
struct Anchor {
  ContactPoint s;
  Vec3 position = Vec3::Zero();  ///< X(s), m
  int node{0};                   ///< surface node, 0-based
  std::optional<double>
      distance{};  ///< of a place that was asked for, to the surface, m, negative inside; none of a node
};

/// What is prescribed at the contact: d in m, f in N, or (t, 0, 0).
struct Question {
  Parameters prescribed{Parameters::kDisplacement};
  Vec3 value = Vec3::Zero();
};

/// What the model answers, from the code that the server runs.
struct Answer {
  ResponseStatus status{ResponseStatus::kNoAnswer};
  Response response;
  std::vector<float> field;  ///< u, [Ns][3], m; zero when not accessible
};

/// s on a node. @param number  the node's number in the mesh file
/// @throw program::UsageError naming the node, when it is not on the surface or has no contact position
[[nodiscard]] Anchor anchorAtNode(const MetaModel& model, std::int64_t number);

/// s as the nearest point of the rest surface. @param c  m, finite
[[nodiscard]] Anchor anchorNear(const MetaModel& model, const Vec3& c);

/// Whether this kind of model has an answer: to a displacement every kind, to a force and to a load level only
/// the model that is driven by it. @throw program::UsageError naming the option, the kind and what to use instead
void checkQuestion(const MetaModel& model, const Question& question);

/// The force of the tool that a prescribed load stands for, N, not clamped. @param question  no displacement
[[nodiscard]] Vec3 forceOf(const MetaModel& model, const Question& question);

/// f, d, df/dd and u at s without release, friction and limiter   docs/design.md, Reproduction, Series, Parts
/// kNoAnswer where the server does not answer either: no node of the triangle is accessible.
/// @param question  passed by checkQuestion(); clamped to the domain like in the server
[[nodiscard]] Answer ask(const MetaModel& model, const Anchor& anchor, const Question& question);

/// The same without the field, which is left empty. @param question  passed by checkQuestion()
[[nodiscard]] Answer askForce(const MetaModel& model, const ContactPoint& s, const Question& question);

/// The same for a displacement. @param d  m
[[nodiscard]] Answer ask(const MetaModel& model, const Anchor& anchor, const Vec3& d);

}  // namespace palpate::query
