// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/together.h"

#include <algorithm>
#include <string>

#include "core/response/tool_coupling.h"
#include "core/tick/workspace.h"
#include "tools/examine/query/arguments.h"
#include "tools/program/exit_code.h"

namespace palpate::query {

namespace {

std::string nodeOf(const MetaModel& model, const Touch& touch) {
  return std::to_string(model.view().surface_mesh_tag[static_cast<std::size_t>(touch.anchor.node)]);
}

void addTo(std::vector<float>& sum, const std::vector<float>& field) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += field[i];
}

std::vector<Vec3> ownOf(const MetaModel& model, std::span<const Touch> touches) {
  std::vector<ContactPoint> s;
  std::vector<Vec3> d, own(touches.size());
  for (const Touch& touch : touches) {
    s.push_back(touch.anchor.s);
    d.push_back(touch.d);
  }
  Touches asked(model);
  ownDisplacements(model, s, d, asked, own);
  return own;
}

/// The answer of a tool alone, moved on to its own part.
Answer withOthers(const MetaModel& model, const Touch& touch, const Answer& alone, const Vec3& own) {
  Answer answer = alone;
  answer.response.force += alone.response.stiffness * (own - touch.d);
  FieldScratch scratch(model);
  evaluateField(model, ownField(model, touch.anchor.s, touch.d, own), scratch, answer.field);
  return answer;
}

JointErrors errors(std::span<const Vec3> forces, const std::vector<float>& field,
                   std::span<const Touch> touches, const FullSolution& truth, const Organ& organ) {
  JointErrors all;
  double length = 0.0;
  for (std::size_t a = 0; a < touches.size(); ++a) {
    all.force.push_back(relativeError(forces[a], truth.state.forces[a]));
    length = std::max(length, touches[a].d.norm());
  }
  all.field = fieldErrors(field, truth, organ, length);
  return all;
}

}  // namespace

Touch parseTouch(const MetaModel& model, const std::string& option, const std::string& text) {
  const NodeAndVector parsed = parseNodeAndVector(option, text);
  return {anchorAtNode(model, parsed.node), parsed.vector};
}

void checkTouches(const MetaModel& model, std::span<const Touch> touches) {
  if (touches.size() > kMaxTools)
    throw program::UsageError("--tool2 is given " + std::to_string(touches.size() - 1) +
                              " times, expected at most " + std::to_string(kMaxTools - 1));
  for (std::size_t a = 0; a < touches.size(); ++a) {
    const Vec3& X = touches[a].anchor.position;
    if (!model.surface().accessible(touches[a].anchor.s.triangle))
      throw program::UsageError("tool " + std::to_string(a + 1) + " near node " + nodeOf(model, touches[a]) +
                                " is not at an accessible point: --tool2 needs an answer at each");
    for (std::size_t b = 0; b < a; ++b)
      if (touches[b].anchor.position == X)
        throw program::UsageError("tools " + std::to_string(b + 1) + " and " + std::to_string(a + 1) +
                                  " both touch node " + nodeOf(model, touches[a]) +
                                  ", expected different places");
  }
}

JointAnswer askTogether(const MetaModel& model, std::span<const Touch> touches) {
  const std::vector<Vec3> own = ownOf(model, touches);
  JointAnswer answer;
  answer.field.assign(3 * static_cast<std::size_t>(model.surface().nodes()), 0.0F);
  answer.superposed = answer.field;
  for (std::size_t a = 0; a < touches.size(); ++a) {
    const Answer alone = ask(model, touches[a].anchor, touches[a].d);
    answer.tools.push_back({own[a], withOthers(model, touches[a], alone, own[a]), alone});
    addTo(answer.field, answer.tools.back().together.field);
    addTo(answer.superposed, alone.field);
  }
  return answer;
}

JointErrors coupledErrors(const JointAnswer& answer, std::span<const Touch> touches,
                          const FullSolution& truth, const Organ& organ) {
  std::vector<Vec3> forces;
  for (const ToolAnswer& tool : answer.tools) forces.push_back(tool.together.response.force);
  return errors(forces, answer.field, touches, truth, organ);
}

JointErrors superposedErrors(const JointAnswer& answer, std::span<const Touch> touches,
                             const FullSolution& truth, const Organ& organ) {
  std::vector<Vec3> forces;
  for (const ToolAnswer& tool : answer.tools) forces.push_back(tool.alone.response.force);
  return errors(forces, answer.superposed, touches, truth, organ);
}

}  // namespace palpate::query
