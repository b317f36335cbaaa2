// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/report.h"

#include <cmath>

#include "core/data/model_view.h"
#include "tools/examine/query/report_lines.h"

namespace palpate::query {

namespace {

using program::Json;

Json rows(const Mat3& m) {
  Json matrix = Json::array();
  for (int row = 0; row < 3; ++row) matrix.push_back(Vec3(m.row(row)));
  return matrix;
}

std::int64_t meshNumber(const Findings& found) {
  return found.model.view().surface_mesh_tag[static_cast<std::size_t>(found.anchor.node)];
}

bool displacementPrescribed(const Findings& found) {
  return found.question.prescribed == Parameters::kDisplacement;
}

Json newtonJson(const Findings& found) {
  const Errors errors = errorsOf(found.answer, *found.truth, *found.organ);
  Json out;
  out["force"] = found.truth->state.force;
  if (displacementPrescribed(found)) {
    out["force_error"] = errors.force;
  } else {
    out["displacement"] = found.truth->d;
    out["displacement_error"] = errors.displacement;
  }
  out["field_error_max"] = errors.field_max;
  out["field_error_l2"] = errors.field_l2;
  out["min_det_f"] = found.truth->min_det_f;
  out["anchor_displacement"] = found.truth->displacement(*found.organ, found.anchor.node);
  return out;
}

/// What was asked for, where it lies beyond the domain.
std::string askedText(const Question& question) {
  switch (question.prescribed) {
    case Parameters::kDisplacement:
      return line("%.6g mm", 1e3 * question.value.norm());
    case Parameters::kForce:
      return line("%.6g N", question.value.norm());
    case Parameters::kLevel:
      break;
  }
  return line("level %.6g", question.value.x());
}

/// How far the asked place is from the point that answers.
std::string distanceText(double distance) {
  return line("%-14s %11.6g mm from the asked place, which is %s the organ\n", "  distance",
              1e3 * std::abs(distance), distance < 0.0 ? "inside" : "outside");
}

std::string newtonText(const Findings& found) {
  const Errors errors = errorsOf(found.answer, *found.truth, *found.organ);
  const solver::NewtonResult& state = found.truth->state;
  return vectorLine("Newton: force", state.force, 1.0, "N") +
         vectorLine("  at the node", found.truth->displacement(*found.organ, found.anchor.node), 1e3, "mm") +
         vectorLine("  displacement", found.truth->d, 1e3, "mm") +
         line("%-14s %s %.3g %%, field %.3g %% of |d| at most, %.3g %% in L2\n", "  model is off",
              displacementPrescribed(found) ? "force" : "displacement",
              100.0 * (displacementPrescribed(found) ? errors.force : errors.displacement),
              100.0 * errors.field_max, 100.0 * errors.field_l2) +
         line("%-14s %.4g; %d iterations, residual %.1e, patch of %zu nodes\n", "  min det F",
              found.truth->min_det_f, state.iterations, state.residual, found.truth->patch.nodes.size());
}

}  // namespace

Json toJson(const Findings& found) {
  const Response& response = found.answer.response;
  const ContactPoint& s = found.anchor.s;
  Json out;
  out["parameters"] = toString(found.model.attributes().parameters);
  out["force"] = response.force;
  out["stiffness"] = rows(response.stiffness);
  out["displacement"] = response.displacement;
  if (found.model.attributes().parameters == Parameters::kLevel) out["load_level"] = response.parameter.x();
  out["anchor"] = {{"node", meshNumber(found)},
                   {"triangle", s.triangle},
                   {"barycentric", s.barycentric},
                   {"position", found.anchor.position}};
  if (found.anchor.distance) out["anchor"]["distance_m"] = *found.anchor.distance;
  out["domain_radius"] = response.domain_radius;
  out["status"] = toString(found.answer.status);
  if (found.truth == nullptr) return out;
  out["newton"] = newtonJson(found);
  return out;
}

std::string toText(const Findings& found) {
  const Response& response = found.answer.response;
  const ContactPoint& s = found.anchor.s;
  std::string text = line("%-14s nearest node %lld, triangle %d (%.4g %.4g %.4g)\n", "anchor",
                          static_cast<long long>(meshNumber(found)), s.triangle, s.barycentric[0],
                          s.barycentric[1], s.barycentric[2]);
  text += vectorLine("  position", found.anchor.position, 1e3, "mm");
  if (found.anchor.distance) text += distanceText(*found.anchor.distance);
  text += line("%-14s %s", "status", std::string(toString(found.answer.status)).c_str());
  if (found.answer.status == ResponseStatus::kNoAnswer)
    text += ": the model has no answer at this point, no force";
  if (found.answer.status == ResponseStatus::kBeyond) text += ": asked for " + askedText(found.question);
  text += '\n';
  text += vectorLine("displacement", response.displacement, 1e3, "mm");
  text += line("%-14s %11.6g mm\n", "domain radius", 1e3 * response.domain_radius);
  text += vectorLine("force on organ", response.force, 1.0, "N");
  if (found.model.attributes().parameters == Parameters::kLevel)
    text += line("%-14s %11.6g of the load\n", "load level", response.parameter.x());
  for (int row = 0; row < 3; ++row)
    text += line("%-14s %11.6g %11.6g %11.6g N/m\n", row == 0 ? "stiffness" : "", response.stiffness(row, 0),
                 response.stiffness(row, 1), response.stiffness(row, 2));
  return found.truth == nullptr ? text : text + newtonText(found);
}

}  // namespace palpate::query
