// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/content.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "core/surface/surface_mesh.h"
#include "tools/examine/certify/report/held_by_tests.h"
#include "tools/modelfile/quantile.h"
#include "tools/modelfile/reach.h"
#include "tools/program/numbers.h"

namespace palpate::certify {

namespace {

using program::Json;

/// A text of the file that should hold an object.
Json provenanceOf(const MetaModel& model) {
  if (auto read = Json::read(model.attributes().provenance); read && read->isObject())
    return *std::move(read);
  return Json::object();
}

Json memberOf(const Json& object, const char* key) {
  const Json* const found = object.find(key);
  return found == nullptr ? Json(nullptr) : *found;
}

/// Of the whole surface and of where tools may be, m^2.
std::array<double, 2> areasOf(const SurfaceMesh& surface) {
  std::array<double, 2> area{};
  for (std::int32_t t = 0; t < surface.triangles(); ++t) {
    const std::array<Vec3, 3> X = surface.corners(t);
    const double one = 0.5 * (X[1] - X[0]).cross(X[2] - X[0]).norm();
    area[0] += one;
    if (surface.accessible(t)) area[1] += one;
  }
  return area;
}

Json contextOf(const ReportInput& input) {
  const auto [surface, accessible] = areasOf(input.model.surface());
  const Json provenance = provenanceOf(input.model);
  Json context{{"travel", input.drawing.travel.length},
               {"travel_from", input.drawing.travel.from},
               {"inward", input.drawing.range.inward},
               {"length", input.drawing.range.length ? Json(*input.drawing.range.length) : Json(nullptr)},
               {"surface_area", surface},
               {"accessible_area", accessible}};
  for (const char* key : {"program", "version", "created", "mesh", "mesh_hash", "case", "method"})
    context["made"][key] = memberOf(provenance, key);
  return context;
}

Json verificationOf(const ReportInput& input) {
  Json held = Json::array();
  for (const HeldByTests& test : kHeldByTests)
    held.push_back(
        {{"what", test.what}, {"figure", test.figure}, {"file", test.file}, {"command", test.command}});
  return {{"in_place",
           {{"rotation", input.checks.rotation},
            {"resultant", input.checks.resultant},
            {"energy_asymmetry", input.certificate["energy_asymmetry"]}}},
          {"held_by_tests", held}};
}

double medianEdge(const ModelView& v) {
  std::vector<double> lengths;
  const auto at = [&](std::int32_t i) {
    return Eigen::Map<const Vec3>(v.surface_positions.data() + 3 * static_cast<std::size_t>(i));
  };
  for (std::size_t t = 0; t < v.contact_triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k)
      lengths.push_back((at(v.contact_triangles[t + k]) - at(v.contact_triangles[t + (k + 1) % 3])).norm());
  std::sort(lengths.begin(), lengths.end());
  return modelfile::quantile(lengths, 0.5);
}

Json meshOf(const ReportInput& input) {
  const ModelView& v = input.model.view();
  return {{"nodes", v.mesh_node_tag.size()},
          {"tetrahedra", v.mesh_tetrahedron_tag.size()},
          {"element_order", v.mesh_midsides.empty() ? 1 : 2},
          {"surface_nodes", v.surfaceNodes()},
          {"contact_positions", v.positions()},
          {"fixed_nodes", v.mesh_fixed.size()},
          {"median_contact_edge", medianEdge(v)},
          {"patch_radius", input.model.attributes().patch_radius},
          {"mesh_error", input.certificate["mesh_error"]}};
}

Json formOf(const ReportInput& input) {
  const ModelView& v = input.model.view();
  const ModelAttributes& a = input.model.attributes();
  Json regions = Json::array();
  for (std::size_t r = 0; r < v.region_name.size(); ++r)
    regions.push_back({{"name", textOf(v.region_name[r])},
                       {"law", textOf(v.region_law[r])},
                       {"E", v.region_E[r]},
                       {"nu", v.region_nu[r]}});
  const double stiffness = std::accumulate(v.spring_stiffness.begin(), v.spring_stiffness.end(), 0.0);
  return {{"law", a.law},
          {"E", a.E},
          {"nu", a.nu},
          {"regions", regions},
          {"springs", {{"nodes", v.spring_node.size()}, {"stiffness", stiffness}}},
          {"order", a.order},
          {"force_order", a.force_order},
          {"modes", v.modes()}};
}

Json curvesOf(const ReportInput& input) {
  Json curves = Json::array();
  for (const ForceCurve& curve : input.curves) {
    Json newton = Json::array();
    for (const ForceCurve::Solved& one : curve.newton)
      newton.push_back({{"depth", one.depth}, {"force", one.force}, {"error", one.error}});
    curves.push_back({{"place", curve.place},
                      {"position", curve.position},
                      {"direction", curve.direction},
                      {"domain_radius", curve.domain_radius},
                      {"depth", curve.depth},
                      {"force", curve.force},
                      {"newton", newton},
                      {"not_converged", curve.not_converged}});
  }
  return {{"youngs_modulus_error",
           input.youngs_modulus_error ? Json(*input.youngs_modulus_error) : Json(nullptr)},
          {"curves", curves}};
}

/// Round travels up to the asked one, m.
std::vector<double> travelsTo(double travel) {
  std::vector<double> travels;
  for (const double mm : program::niceTicks(0.0, 1e3 * travel, 7))
    if (mm > 0.0 && 1e-3 * mm < 0.999 * travel) travels.push_back(1e-3 * mm);
  travels.push_back(travel);
  return travels;
}

Json applicabilityOf(const ReportInput& input) {
  const ModelView& v = input.model.view();
  const modelfile::Positions positions{v.surface_positions, v.contact_triangles, v.position_of_node,
                                       v.contact_accessible};
  Json reach = Json::array();
  for (const double travel : travelsTo(input.drawing.travel.length))
    reach.push_back({{"travel", travel},
                     {"share", modelfile::reachingShare(positions, v.contact_domain_radius, travel)}});
  return {{"reach", reach},
          {"domain_radius", modelfile::radiusJson(v.contact_accessible, v.contact_domain_radius)}};
}

Json listOf(const std::vector<std::optional<double>>& numbers) {
  Json list = Json::array();
  for (const auto& number : numbers) list.push_back(number ? Json(*number) : Json(nullptr));
  return list;
}

}  // namespace

Json contentOf(const ReportInput& input) {
  const ModelView& v = input.model.view();
  return {{"program", "palpate-certify"},
          {"version", PALPATE_VERSION},
          {"model", input.file},
          {"model_id", input.model.id()},
          {"sha256", input.model.digest().hex()},
          {"status", input.status},
          {"context_of_use", contextOf(input)},
          {"code_verification", verificationOf(input)},
          {"mesh", meshOf(input)},
          {"model_form", formOf(input)},
          {"certificate", input.certificate},
          {"touches", touchesOf(input.found)},
          {"uncertainty", curvesOf(input)},
          {"applicability", applicabilityOf(input)},
          {"surface",
           {{"positions", v.surface_positions},
            {"triangles", v.surface_triangles},
            {"domain_radius", listOf(input.maps.domain_radius)},
            {"normal_stiffness", listOf(input.maps.normal_stiffness)}}}};
}

}  // namespace palpate::certify
