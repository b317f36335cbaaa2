// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/summary.h"

#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "tools/make/solve/chosen.h"
#include "tools/modelfile/reach.h"

namespace palpate::solve_program {

namespace {

using program::Json;
using solver::Method;

bool isSeries(Method method) {
  return method == Method::kSeriesDisplacement || method == Method::kSeriesForce;
}

double peakMemoryMiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Name of the domain radius of each kind, as palpate-inspect names it.
const char* radiusKey(Parameters parameters) {
  switch (parameters) {
    case Parameters::kForce:
      return "force_radius";
    case Parameters::kLevel:
      return "level_radius";
    default:
      return "domain_radius";
  }
}

modelfile::Positions positionsOf(const modelfile::ModelData& data) {
  return {data.surface_positions, data.contact_triangles, data.position_of_node, data.contact_accessible};
}

}  // namespace

Json meshErrorOf(const solver::BuildReport& report) {
  const solver::MeshError& e = *report.mesh_error;
  Json error{{"points", e.points},
             {"against", e.raised ? "quadratic elements" : "elements of half the size"}};
  error["mean"] = e.points > 0 ? Json(e.mean) : Json();
  error["max"] = e.points > 0 ? Json(e.largest) : Json();
  return error;
}

Json sizeOf(const solver::BuildReport& report) {
  const solver::SizeChoice& size = *report.size;
  return {{"limit", size.limit},       {"fixed", size.fixed},
          {"modes", size.modes},       {"near_fields", size.near_fields},
          {"left_out", size.left_out}, {"shared_loads", report.shared_loads}};
}

Json stages(Method method, const solver::BuildReport& report) {
  if (isSeries(method)) {
    Json seconds{
        {"factor", report.factor_seconds}, {"series", report.series_seconds}, {"fit", report.fit_seconds}};
    if (report.mesh_error) seconds["mesh_error"] = report.mesh_error_seconds;
    if (report.travel) seconds["orders"] = report.orders_seconds;
    if (report.kept_seconds > 0.0) seconds["kept"] = report.kept_seconds;
    return seconds;
  }
  Json seconds{{"factor", report.factor_seconds}, {"pgd", report.pgd_seconds}};
  if (method == Method::kPgdLinear) seconds["recompression"] = report.recompression_seconds;
  return seconds;
}

Json loadOf(const solver::Case& c, const solver::BuildReport& report) {
  if (isSeries(c.method)) return Json::object();
  const solver::Vec3 e = c.load.unitDirection();
  Json load{{"magnitude", report.load}, {"kind", c.nodalLoad() ? "node" : "patch"}};
  load["direction"] = c.load.any_direction ? Json("any") : Json(e);
  if (c.method == Method::kPgdLinear) {
    load["truncation"] = c.load.truncation.value_or(0);
    load["truncation_error"] = report.load_truncation;
  } else {
    load["steps"] = c.load.stepsOrDefault();
  }
  return load;
}

Json summarize(const std::filesystem::path& output, const solver::Case& c, const modelfile::ModelData& data,
               const solver::BuildReport& report, double write_seconds, double total_seconds) {
  Json seconds = stages(c.method, report);
  seconds["write"] = write_seconds;
  seconds["total"] = total_seconds;
  const Parameters parameters = data.attributes.parameters;
  Json s{{"model", output.string()},
         {"method", toString(c.method)},
         {"parameters", std::string(toString(parameters))},
         {"nodes", data.mesh_node_tag.size()},
         {"tetrahedra", data.mesh_tetrahedron_tag.size()},
         {"element_order", data.mesh_midsides.empty() ? 1 : 2},
         {"surface_nodes", data.surface_mesh_tag.size()},
         {"contact_positions", data.contact_node.size()},
         {"patch_radius", data.attributes.patch_radius},
         {"modes", data.modes_X.size() / (3 * data.surface_mesh_tag.size())},
         {radiusKey(parameters), modelfile::radiusJson(data.contact_accessible, data.contact_domain_radius)},
         {"seconds", seconds},
         {"file_bytes", std::filesystem::file_size(output)},
         {"peak_memory_MiB", peakMemoryMiB()}};
  if (parameters == Parameters::kDisplacement) {
    s["series_radius"] = modelfile::radiusJson(data.contact_accessible, data.contact_series_radius);
    s["reach"] =
        modelfile::reachJson(positionsOf(data), data.contact_domain_radius, data.contact_series_radius);
  }
  if (parameters != Parameters::kLevel) s["order"] = data.attributes.order;
  if (parameters == Parameters::kDisplacement) s["force_order"] = data.attributes.force_order;
  if (parameters == Parameters::kForce) {
    s["reference_force"] = data.attributes.reference_force;
    s["weak_positions"] = report.weak_positions;
  }
  if (report.median_edge > 0.0) s["median_surface_edge"] = report.median_edge;
  if (report.mesh_error) s["mesh_error"] = meshErrorOf(report);
  s["target"] = c.handheld() ? "handheld" : "server";
  if (report.size) s["size"] = sizeOf(report);
  if (const auto& travel = report.travel)
    s["travel"] = {
        {"travel", travel->travel},
        {"reaching", travel->reaching},
        {"places", travel->places},
        {"within", travel->within},
        {"touches", modelfile::touchesWithin(positionsOf(data), data.contact_domain_radius, travel->travel)},
        {"share", modelfile::reachingShare(positionsOf(data), data.contact_domain_radius, travel->travel)}};
  if (c.method == Method::kSeriesDisplacement) {
    s["chosen"] = chosenOf(c, data, report);
    s["positions"] = {{"corners", data.contact_node.size()}, {"mid_edges", report.edges.solved}};
    s["sides"] = modelfile::sidesJson(positionsOf(data), data.contact_domain_radius, c.travelOrDefault());
  }
  if (isSeries(c.method)) {
    s["fit_error"] = report.fit_errors.back();
    if (parameters == Parameters::kDisplacement) {
      s["near_radius"] = data.attributes.near_radius;
      if (report.size) return s;  // the fit's errors are not those of what is left of it
      s["fit_p95"] = report.fit_p95;
      s["fit_max"] = report.fit_max;
      s["fit_asked"] = report.fit_asked;
    }
    return s;
  }
  s["load"] = loadOf(c, report);
  s["pairs"] = report.greedy_pairs;
  s["residual"] = report.residual;
  s["recompression_error"] = report.truncation;
  return s;
}

}  // namespace palpate::solve_program
