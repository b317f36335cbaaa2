// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <array>
#include <cstdio>

namespace palpate::query {

namespace {

using Json = nlohmann::ordered_json;

Json list(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

Json rows(const Mat3& m) {
  Json matrix = Json::array();
  for (int row = 0; row < 3; ++row) matrix.push_back(list(m.row(row)));
  return matrix;
}

std::int64_t meshNumber(const Findings& found) {
  return found.model.view().surface_mesh_tag[static_cast<std::size_t>(found.anchor.node)];
}

template <class... Values>
std::string line(const char* format, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

std::string vectorLine(const char* name, const Vec3& v, double factor, const char* unit) {
  return line("%-14s %11.6g %11.6g %11.6g %s, size %.6g\n", name, factor * v[0], factor * v[1], factor * v[2],
              unit, factor * v.norm());
}

std::string newtonText(const Findings& found) {
  const Errors errors = errorsOf(found.answer, *found.truth, *found.organ, found.d);
  const offline::NewtonResult& state = found.truth->state;
  return vectorLine("Newton: force", state.force, 1.0, "N") +
         vectorLine("  at the node", found.truth->displacement(*found.organ, found.anchor.node), 1e3, "mm") +
         line("%-14s force %.3g %%, field %.3g %% of |d| at most, %.3g %% in L2\n", "  model is off",
              100.0 * errors.force, 100.0 * errors.field_max, 100.0 * errors.field_l2) +
         line("%-14s %.4g; %d iterations, residual %.1e, patch of %zu nodes\n", "  min det F",
              found.truth->min_det_f, state.iterations, state.residual, found.truth->patch.nodes.size());
}

}  // namespace

Json toJson(const Findings& found) {
  const Response& response = found.answer.response;
  const ContactPoint& s = found.anchor.s;
  Json out;
  out["force"] = list(response.force);
  out["stiffness"] = rows(response.stiffness);
  out["displacement"] = list(response.displacement);
  out["anchor"] = {{"node", meshNumber(found)},
                   {"triangle", s.triangle},
                   {"barycentric", s.barycentric},
                   {"position", list(found.anchor.position)}};
  out["domain_radius"] = response.domain_radius;
  out["status"] = toString(found.answer.status);
  if (found.truth == nullptr) return out;
  const Errors errors = errorsOf(found.answer, *found.truth, *found.organ, found.d);
  out["newton"] = {{"force", list(found.truth->state.force)},
                   {"force_error", errors.force},
                   {"field_error_max", errors.field_max},
                   {"field_error_l2", errors.field_l2},
                   {"min_det_f", found.truth->min_det_f},
                   {"anchor_displacement", list(found.truth->displacement(*found.organ, found.anchor.node))}};
  return out;
}

std::string toText(const Findings& found) {
  const Response& response = found.answer.response;
  const ContactPoint& s = found.anchor.s;
  std::string text = line("%-14s nearest node %lld, triangle %d (%.4g %.4g %.4g)\n", "anchor",
                          static_cast<long long>(meshNumber(found)), s.triangle, s.barycentric[0],
                          s.barycentric[1], s.barycentric[2]);
  text += vectorLine("  position", found.anchor.position, 1e3, "mm");
  text += line("%-14s %s", "status", std::string(toString(found.answer.status)).c_str());
  if (found.answer.status == ResponseStatus::kNoAnswer)
    text += ": the model has no answer at this point, no force";
  if (found.answer.status == ResponseStatus::kClamped)
    text += line(": asked for %.6g mm, beyond the domain", 1e3 * found.d.norm());
  text += '\n';
  text += vectorLine("displacement", response.displacement, 1e3, "mm");
  text += line("%-14s %11.6g mm\n", "domain radius", 1e3 * response.domain_radius);
  text += vectorLine("force on organ", response.force, 1.0, "N");
  for (int row = 0; row < 3; ++row)
    text += line("%-14s %11.6g %11.6g %11.6g N/m\n", row == 0 ? "stiffness" : "", response.stiffness(row, 0),
                 response.stiffness(row, 1), response.stiffness(row, 2));
  return found.truth == nullptr ? text : text + newtonText(found);
}

}  // namespace palpate::query
