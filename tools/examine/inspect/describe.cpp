// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/inspect/describe.h"

#include <algorithm>
#include <iomanip>
#include <numeric>
#include <sstream>

#include "core/data/model_view.h"
#include "tools/modelfile/reach.h"
#include "tools/program/certificate_line.h"
#include "tools/program/printed.h"

namespace palpate::inspect {

namespace {

using program::Json;

template <typename... T>
std::size_t bytesOf(const T&... parts) {
  return (parts.size_bytes() + ...);
}

Json bytesOfParts(const ModelView& v) {
  Json bytes;
  bytes["surface"] =
      bytesOf(v.surface_positions, v.surface_triangles, v.surface_mesh_tag, v.position_of_node);
  bytes["contact_response"] = bytesOf(v.contact_node, v.contact_accessible, v.contact_triangles,
                                      v.contact_force, v.contact_displacement, v.contact_stiffness,
                                      v.contact_domain_radius, v.contact_series_radius, v.levels_Z);
  bytes["far_field"] = bytesOf(v.modes_X, v.modes_X_scale, v.modes_Y, v.modes_Y_scale);
  bytes["near_field"] = bytesOf(v.near_offset, v.near_node, v.near_field, v.near_scale);
  bytes["greens_functions"] = bytesOf(v.green_node, v.green_Y, v.green_Y_scale, v.green_offset,
                                      v.green_near_node, v.green_near, v.green_near_scale);
  bytes["edges"] = bytesOf(v.edge_offset, v.edge_node, v.edge_field, v.edge_scale);
  bytes["mesh"] =
      bytesOf(v.mesh_nodes, v.mesh_tetrahedra, v.mesh_midsides, v.mesh_node_tag, v.mesh_tetrahedron_tag,
              v.mesh_fixed, v.mesh_surface_node, v.mesh_element_region, v.region_name, v.region_E,
              v.region_nu, v.region_law, v.spring_node, v.spring_stiffness);
  return bytes;
}

/// Of the accessible positions: m, N, or a level.
Json radii(const ModelView& v, std::span<const double> radius) {
  return modelfile::radiusJson(v.contact_accessible, radius);
}

/// What the model is trusted for, and the load of the load-driven kinds.
void describeDomain(const MetaModel& model, Json& out) {
  const ModelView& v = model.view();
  const ModelAttributes& a = model.attributes();
  const bool displaced = a.parameters == Parameters::kDisplacement;
  out["domain_radius"] = displaced ? radii(v, v.contact_domain_radius) : Json(nullptr);
  out["series_radius"] = displaced ? radii(v, v.contact_series_radius) : Json(nullptr);
  if (displaced)
    out["reach"] = modelfile::reachJson(
        {v.surface_positions, v.contact_triangles, v.position_of_node, v.contact_accessible},
        v.contact_domain_radius, v.contact_series_radius);
  if (a.parameters == Parameters::kForce) {
    out["reference_force"] = a.reference_force;
    out["force_radius"] = radii(v, v.contact_domain_radius);
  }
  if (a.parameters != Parameters::kLevel) return;
  out["level_radius"] = radii(v, v.contact_domain_radius);
  out["load"] = {{"size", a.load},
                 {"direction", a.load_direction},
                 {"level_functions", v.level_functions},
                 {"level_steps", model.functions().levelSteps()}};
}

/// Regions and springs, where there are any.
void describeMaterial(const ModelView& v, Json& out) {
  if (!v.region_name.empty()) {
    Json regions = Json::object();
    for (std::size_t r = 0; r < v.region_name.size(); ++r)
      regions[textOf(v.region_name[r])] = {
          {"law", textOf(v.region_law[r])},
          {"E", v.region_E[r]},
          {"nu", v.region_nu[r]},
          {"tetrahedra", std::count(v.mesh_element_region.begin(), v.mesh_element_region.end(), r)}};
    out["regions"] = regions;
  }
  if (v.spring_node.empty()) return;
  out["springs"] = {
      {"nodes", v.spring_node.size()},
      {"stiffness", std::accumulate(v.spring_stiffness.begin(), v.spring_stiffness.end(), 0.0)}};
}

/// A text of the file that holds an object.
Json objectOf(const std::string& text) {
  if (auto parsed = Json::read(text); parsed && parsed->isObject()) return *std::move(parsed);
  return {{"text", text}};
}

/// Texts of a file go to a terminal, which obeys control characters: those of one byte become \xNN, C1 in UTF-8 too.
std::string printable(const std::string& text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[i])) : 0x20U;
  };
  const auto isC1 = [&](std::size_t i) {
    return byte(i) == 0xc2 && byte(i + 1) >= 0x80 && byte(i + 1) < 0xa0;
  };
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool control = byte(i) < 0x20 || byte(i) == 0x7f || isC1(i) || (i > 0 && isC1(i - 1));
    out += control ? program::printed("\\x%02x", byte(i)) : text.substr(i, 1);
  }
  return out;
}

std::string valueText(const Json& value) {
  return value.isString() ? value.text() : value.dump(-1, program::Keys::kAsWritten);
}

std::string reachText(const Json& r) {
  return program::printed("%.1f %% of the surface by domain_radius, %.1f %% by series_radius",
                          100.0 * r["by_domain_radius"].get<double>(),
                          100.0 * r["by_series_radius"].get<double>());
}

}  // namespace

Json describe(const MetaModel& model) {
  const ModelView& v = model.view();
  const ModelAttributes& a = model.attributes();
  Json out;
  out["model_id"] = model.id();
  out["digest"] = {{"sha256", model.digest().hex()},
                   {"verified", true}};  // else it would not have been loaded
  out["parameters"] = toString(a.parameters);
  out["nodes"] = v.mesh_node_tag.size();
  out["tetrahedra"] = v.mesh_tetrahedron_tag.size();
  out["element_order"] = v.mesh_midsides.empty() ? 1 : 2;
  out["surface_nodes"] = v.surfaceNodes();
  out["surface_triangles"] = v.triangles();
  out["accessible_nodes"] = std::count(v.contact_accessible.begin(), v.contact_accessible.end(), 1);
  out["contact_positions"] = v.positions();
  out["modes"] = v.modes();
  const bool polynomial = a.parameters != Parameters::kLevel;
  out["order"] = polynomial ? Json(a.order) : Json(nullptr);
  out["force_order"] = polynomial ? Json(a.force_order) : Json(nullptr);
  out["coefficients"] = model.functions().size();
  out["patch_radius"] = a.patch_radius;
  out["near_radius"] = a.near_radius;
  out["near_nodes_mean"] = static_cast<double>(v.near_node.size()) / static_cast<double>(v.positions());
  out["reference_displacement"] = a.reference_displacement;
  out["rounded_triangles"] = a.rounded_triangles;
  describeDomain(model, out);
  out["material"] = {{"law", a.law}, {"E", a.E}, {"nu", a.nu}};
  describeMaterial(v, out);
  out["file_bytes"] = model.bytes();
  out["bytes"] = bytesOfParts(v);
  out["certificate"] = a.certificate.empty() ? Json(nullptr) : objectOf(a.certificate);
  out["provenance"] = objectOf(a.provenance);
  return out;
}

std::string table(const Json& description) {
  std::ostringstream out;
  const auto line = [&](const std::string& key, const std::string& value) {
    out << std::left << std::setw(26) << printable(key) + ' ' << printable(value) << '\n';
  };
  for (const auto& [key, value] : description.members()) {
    if (key == "certificate") line(key, program::certificateLine(value.isNull() ? "" : value.dump()));
    if (key == "reach") {
      for (const Json& r : value.entries())
        line("reach." + program::printed("%.0f_mm", 1e3 * r["travel"].get<double>()), reachText(r));
    } else if (value.isObject()) {
      for (const auto& [inner, number] : value.members()) line(key + "." + inner, valueText(number));
    } else if (key != "certificate") {
      line(key, valueText(value));
    }
  }
  return out.str();
}

}  // namespace palpate::inspect
