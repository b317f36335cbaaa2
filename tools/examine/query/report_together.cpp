// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/report_together.h"

#include <algorithm>

#include "tools/examine/query/report_lines.h"

namespace palpate::query {

namespace {

using program::Json;

Vec3 couplingForce(const ToolAnswer& tool) {
  return tool.together.response.force - tool.alone.response.force;
}

std::string key(const char* before, std::size_t tool, const char* after) {
  return before + std::to_string(tool + 1) + after;
}

std::int64_t meshNumber(const JointFindings& found, std::size_t tool) {
  const int node = found.touches[tool].anchor.node;
  return found.model.view().surface_mesh_tag[static_cast<std::size_t>(node)];
}

double distance(const JointFindings& found, std::size_t tool) {
  return (found.touches[tool].anchor.position - found.touches.front().anchor.position).norm();
}

Json toolJson(const JointFindings& found, std::size_t a) {
  const ToolAnswer& tool = found.answer.tools[a];
  return {{"node", meshNumber(found, a)},          {"position", found.touches[a].anchor.position},
          {"distance_m", distance(found, a)},      {"displacement", found.touches[a].d},
          {"own_displacement", tool.own},          {"status", toString(tool.together.status)},
          {"force", tool.together.response.force}, {"force_alone", tool.alone.response.force}};
}

void addErrors(const JointErrors& errors, Json& out) {
  for (std::size_t a = 0; a < errors.force.size(); ++a) out[key("force", a, "_error")] = errors.force[a];
  out["field_error_max"] = errors.field.max;
  out["field_error_l2"] = errors.field.l2;
}

Json newtonJson(const JointFindings& found) {
  const Vec3 change = found.truth->state.force - found.alone->state.force;
  Json out{{"forces", Json::array()}};
  for (const Vec3& force : found.truth->state.forces) out["forces"].push_back(force);
  out["coupling_force1_N"] = change.norm();
  out["min_det_f"] = found.truth->min_det_f;
  return out;
}

std::string errorsLine(const char* name, const JointErrors& errors) {
  std::string text = line("%-14s force", name);
  for (const double error : errors.force) text += line(" %.3g", 100.0 * error);
  return text + line(" %%, field %.3g %% of |d| at most, %.3g %% in L2\n", 100.0 * errors.field.max,
                     100.0 * errors.field.l2);
}

std::string toolText(const JointFindings& found, std::size_t a) {
  const ToolAnswer& tool = found.answer.tools[a];
  std::string text = line("tool %-9zu node %lld, %.4g mm from tool 1, %s\n", a + 1,
                          static_cast<long long>(meshNumber(found, a)), 1e3 * distance(found, a),
                          std::string(toString(tool.together.status)).c_str());
  text += vectorLine("  displacement", found.touches[a].d, 1e3, "mm");
  text += vectorLine("  own part", tool.own, 1e3, "mm");
  text += vectorLine("  force", tool.together.response.force, 1.0, "N");
  return text + vectorLine("  by the others", couplingForce(tool), 1.0, "N");
}

std::string newtonText(const JointFindings& found) {
  std::string text;
  for (std::size_t a = 0; a < found.touches.size(); ++a)
    text += vectorLine(key("Newton: force", a, "").c_str(), found.truth->state.forces[a], 1.0, "N");
  text += vectorLine("  by the others", found.truth->state.force - found.alone->state.force, 1.0, "N");
  text +=
      errorsLine("  model is off", coupledErrors(found.answer, found.touches, *found.truth, *found.organ));
  text +=
      errorsLine("  superposed", superposedErrors(found.answer, found.touches, *found.truth, *found.organ));
  return text + line("%-14s %.4g; %d iterations, residual %.1e\n", "  min det F", found.truth->min_det_f,
                     found.truth->state.iterations, found.truth->state.residual);
}

}  // namespace

Json toJson(const JointFindings& found) {
  Json out;
  if (found.truth != nullptr)
    addErrors(coupledErrors(found.answer, found.touches, *found.truth, *found.organ), out);
  for (std::size_t a = 0; a < found.touches.size(); ++a)
    out[key("coupling_force", a, "_N")] = couplingForce(found.answer.tools[a]).norm();
  for (std::size_t a = 0; a < found.touches.size(); ++a) out["tools"].push_back(toolJson(found, a));
  if (found.truth == nullptr) return out;
  addErrors(superposedErrors(found.answer, found.touches, *found.truth, *found.organ), out["superposed"]);
  out["newton"] = newtonJson(found);
  return out;
}

std::string toText(const JointFindings& found) {
  std::string text = "together:\n";
  for (std::size_t a = 0; a < found.touches.size(); ++a) text += toolText(found, a);
  return found.truth == nullptr ? text : text + newtonText(found);
}

}  // namespace palpate::query
