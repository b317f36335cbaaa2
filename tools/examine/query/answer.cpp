// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/answer.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "core/response/patch_response.h"
#include "core/surface/surface_mesh.h"
#include "tools/program/exit_code.h"

namespace palpate::query {

namespace {

Eigen::Map<const Vec3> nodePosition(const MetaModel& model, int node) {
  return Eigen::Map<const Vec3>(model.view().surface_positions.data() + 3 * static_cast<std::size_t>(node));
}

int nearestNode(const MetaModel& model, const Vec3& x) {
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int node = 0; node < model.surface().nodes(); ++node) {
    const double distance = (nodePosition(model, node) - x).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = node;
  }
  return nearest;
}

/// The surface node of that number. @throw program::UsageError
int surfaceNode(const MetaModel& model, std::int64_t number) {
  const ModelView& view = model.view();
  const auto& tags = view.surface_mesh_tag;
  const auto found = std::find(tags.begin(), tags.end(), number);
  if (found != tags.end()) return static_cast<int>(found - tags.begin());
  const bool inside =
      std::find(view.mesh_node_tag.begin(), view.mesh_node_tag.end(), number) != view.mesh_node_tag.end();
  throw program::UsageError(
      "node " + std::to_string(number) +
      (inside ? " lies inside the organ, expected one on its surface"
              : " is not in the mesh, which has " + std::to_string(view.mesh_node_tag.size()) + " nodes"));
}

/// The node as a point of a triangle that may be touched: a node at the rim belongs to others as well.
ContactPoint touchableAt(const MetaModel& model, int node) {
  const auto& corners = model.view().contact_triangles;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto triangle = static_cast<std::int32_t>(i / 3);
    if (corners[i] != node || !model.surface().accessible(triangle)) continue;
    ContactPoint s{triangle, {}};
    s.barycentric[i % 3] = 1.0;
    return s;
  }
  return model.surface().atNode(node);
}

const char* optionOf(Parameters parameters) {
  switch (parameters) {
    case Parameters::kForce:
      return "--force";
    case Parameters::kLevel:
      return "--load-level";
    case Parameters::kDisplacement:
      break;
  }
  return "--displacement";
}

}  // namespace

Anchor anchorAtNode(const MetaModel& model, std::int64_t number) {
  const int node = surfaceNode(model, number);
  if (model.view().position_of_node[static_cast<std::size_t>(node)] < 0)
    throw program::UsageError("node " + std::to_string(number) +
                              " has no contact position: it is clamped or not accessible");
  return {touchableAt(model, node), nodePosition(model, node), node, {}};
}

Anchor anchorNear(const MetaModel& model, const Vec3& c) {
  const NearestPoint nearest = model.surface().closestPoint(c);
  return {nearest.s, nearest.position, nearestNode(model, nearest.position), nearest.signed_distance};
}

void checkQuestion(const MetaModel& model, const Question& question) {
  const Parameters kind = model.attributes().parameters;
  if (question.prescribed == Parameters::kDisplacement || question.prescribed == kind) return;
  const std::string asked = optionOf(question.prescribed), own = optionOf(kind);
  throw program::UsageError(asked + " asks a model driven by " + std::string(toString(question.prescribed)) +
                            ", this one is driven by " + std::string(toString(kind)) + ": use " +
                            (kind == Parameters::kDisplacement ? own : own + " or --displacement"));
}

Vec3 forceOf(const MetaModel& model, const Question& question) {
  if (question.prescribed == Parameters::kForce) return question.value;
  const ModelAttributes& a = model.attributes();
  return question.value.x() * a.load * Eigen::Map<const Vec3>(a.load_direction.data());
}

Answer askForce(const MetaModel& model, const ContactPoint& s, const Question& question) {
  Answer answer;
  if (!model.surface().accessible(s.triangle)) return answer;
  answer.status = question.prescribed == Parameters::kDisplacement
                      ? respond(model, s, question.value, answer.response)
                      : respondToLoad(model, s, question.value, answer.response);
  return answer;
}

Answer ask(const MetaModel& model, const Anchor& anchor, const Question& question) {
  Answer answer = askForce(model, anchor.s, question);
  answer.field.assign(3 * static_cast<std::size_t>(model.surface().nodes()), 0.0F);
  if (answer.status == ResponseStatus::kNoAnswer) return answer;
  FieldScratch scratch(model);
  const std::array<FieldSource, 1> source{FieldSource{anchor.s, answer.response.parameter, 1.0}};
  evaluateField(model, source, scratch, answer.field);
  return answer;
}

Answer ask(const MetaModel& model, const Anchor& anchor, const Vec3& d) {
  return ask(model, anchor, Question{Parameters::kDisplacement, d});
}

}  // namespace palpate::query
