// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/summary.h"

#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <string>

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

void printTimes(const Json& seconds) {
  std::string line = "time:";
  const std::pair<const char*, const char*> names[] = {{"factor", "factor"},
                                                       {"mesh_error", "the mesh's error"},
                                                       {"orders", "orders"},
                                                       {"series", "series"},
                                                       {"fit", "fit"},
                                                       {"pgd", "PGD"},
                                                       {"recompression", "recompression"},
                                                       {"write", "writing"},
                                                       {"total", "together"}};
  for (const auto& [key, name] : names) {
    if (!seconds.contains(key)) continue;
    char part[64];
    std::snprintf(part, sizeof part, "%s %s %.1f s", line.back() == ':' ? "" : ",", name,
                  seconds[key].get<double>());
    line += part;
  }
  std::fprintf(stderr, "%s\n", line.c_str());
}

void printFit(const Json& s) {
  if (!s.contains("fit_p95")) return;
  const double p95 = s["fit_p95"].get<double>(), asked = s["fit_asked"].get<double>();
  const auto modes = s["modes"].get<std::size_t>();
  std::fprintf(stderr,
               "near field to %.2f mm (%.2g patch radii), %zu modes%s: largest error of the field %.2f %% "
               "(p95), %.2f %% (max) of d",
               1e3 * s["near_radius"].get<double>(),
               s["near_radius"].get<double>() / s["patch_radius"].get<double>(), modes,
               asked > 0.0 ? ", chosen by its error" : "", 100.0 * p95, 100.0 * s["fit_max"].get<double>());
  if (asked > 0.0) std::fprintf(stderr, "; asked %.2f %%", 100.0 * asked);
  std::fputc('\n', stderr);
  if (asked > 0.0 && p95 > asked)
    std::fprintf(stderr,
                 "warning: %zu modes do not reach the asked error; a larger near_radius or patch_radius does "
                 "with less\n",
                 modes);
}

int wholeOr0(const Json& object, const char* key) {
  const Json* const member = object.find(key);
  return member == nullptr ? 0 : member->get<int>();
}

/// What the mesh gets wrong, and whether patches are too narrow for it.
void printMesh(const Json& s) {
  constexpr double kMuch = 0.05;
  const bool quadratic = s["element_order"] == 2;
  const Json* const edge = s.find("median_surface_edge");
  const double edges = edge == nullptr ? 0.0 : s["patch_radius"].get<double>() / edge->get<double>();
  const double enough = quadratic ? 0.8 : 1.3;
  constexpr double kRounding = 1e-6;  // a default patch is just wide enough
  if (edge != nullptr && edges < enough - kRounding)
    std::fprintf(
        stderr,
        "warning: a patch is %.2f median surface edges wide, less than %.1f: the force follows the mesh\n",
        edges, enough);
  const Json* const error = s.find("mesh_error");
  if (error == nullptr) return;
  if (error->at("points") == 0) {
    std::fprintf(stderr, "mesh: its error could not be looked at anywhere\n");
    return;
  }
  const double mean = error->at("mean").get<double>();
  const bool raised = error->at("against") == "quadratic elements";
  std::fprintf(stderr, "mesh: too stiff by %s%.1f %% (mean), %.1f %% (largest), at %d points, against %s\n",
               quadratic || raised ? "" : "at least ", 100.0 * mean, 100.0 * error->at("max").get<double>(),
               error->at("points").get<int>(), error->at("against").get<std::string>().c_str());
  if (mean > kMuch)
    std::fprintf(stderr,
                 "warning: the mesh makes the organ too stiff by more than 5 %%: smaller elements%s help\n",
                 quadratic ? "" : " or --element-order 2");
}

void printRadius(const Json& s) {
  const auto line = [](const Json& radius, const char* name, double scale, const char* unit) {
    if (radius.isNull()) return;
    std::fprintf(stderr, "%s: 5 %% quantile %.4g %s, median %.4g %s; ", name,
                 scale * radius["p05"].get<double>(), unit, scale * radius["median"].get<double>(), unit);
  };
  if (s.contains("domain_radius")) line(s["domain_radius"], "domain radius", 1e3, "mm");
  if (s.contains("series_radius"))
    line(s["series_radius"], "polynomials run to, flagged beyond the domain radius", 1e3, "mm");
  if (s.contains("force_radius")) line(s["force_radius"], "largest force", 1.0, "N");
  if (s.contains("level_radius")) line(s["level_radius"], "largest load level", 1.0, "of the load");
  if (s.contains("fit_error"))
    std::fprintf(stderr, "RMS error of the fit %.2f %%", 100.0 * s["fit_error"].get<double>());
  else
    std::fprintf(stderr, "%d pairs before recompression, their residual %.2e", s["pairs"].get<int>(),
                 s["residual"].get<double>());
  const Json* const load = s.find("load");
  if (load != nullptr && wholeOr0(*load, "truncation") > 0)
    std::fprintf(stderr, ", load of %d terms wrong by %.2e", wholeOr0(*load, "truncation"),
                 load->at("truncation_error").get<double>());
  if (const int weak = wholeOr0(s, "weak_positions"); weak > 0)
    std::fprintf(stderr, "; %d positions need more modes", weak);
  std::fputc('\n', stderr);
}

/// What a travel chose, and how much of the file reaches it.
void printTravel(const Json& s) {
  const Json* const travel = s.find("travel");
  if (travel == nullptr) return;
  const double mm = 1e3 * travel->at("travel").get<double>(), share = travel->at("share").get<double>();
  std::fprintf(stderr,
               "travel of %.4g mm: fields of degree %d, force of %d; %d of %d trial positions reach it by "
               "their own radius\n",
               mm, s["order"].get<int>(), s["force_order"].get<int>(), travel->at("reaching").get<int>(),
               travel->at("places").get<int>());
  if (share < 0.5)
    std::fprintf(stderr,
                 "warning: the domain radius reaches %.4g mm on %.0f %% of the accessible surface (it is the "
                 "least within two rings of triangles); elsewhere the model answers too, and flags what is "
                 "beyond it\n",
                 mm, 100.0 * share);
}

/// What a size limit chose, and what would make a file fit that does not.
void printSize(const Json& s) {
  const Json* const size = s.find("size");
  if (size == nullptr) return;
  const auto mb = [&](const char* key) { return 1e-6 * size->at(key).get<double>(); };
  const double bytes = 1e-6 * s["file_bytes"].get<double>();
  std::fprintf(
      stderr,
      "handheld, at most %.4g MB: modes take %.2f MB, near fields %.2f MB, all else %.2f MB; near fields "
      "leave out nodes that one position or load, by itself, moves by less than %.2f %% of d\n",
      mb("limit"), mb("modes"), mb("near_fields"), mb("fixed"), 100.0 * size->at("left_out").get<double>());
  if (bytes > mb("limit"))
    std::fprintf(
        stderr,
        "warning: the file has %.4g MB, more than the asked %.4g: --size-limit %.0f fits, and so may larger "
        "elements (%zu surface nodes), a smaller accessible part (%zu contact positions) or a lower order\n",
        bytes, mb("limit"), 1e6 * std::ceil(10.0 * bytes) / 10.0, s["surface_nodes"].get<std::size_t>(),
        s["contact_positions"].get<std::size_t>());
  std::fprintf(stderr, "errors of force and field against Newton: palpate-certify %s\n",
               s["model"].get<std::string>().c_str());
}

/// How far tools may press.
void printReach(const Json& s) {
  if (!s.contains("reach")) return;
  std::fprintf(stderr, "accessible surface whose domain radius reaches");
  for (std::size_t i = 0; i < s["reach"].size(); ++i) {
    const Json& r = s["reach"][i];
    std::fprintf(stderr, "%s %.0f mm: %.0f %% (polynomials run to it: %.0f %%)", i == 0 ? "" : ",",
                 1e3 * r.at("travel").get<double>(), 100.0 * r.at("by_domain_radius").get<double>(),
                 100.0 * r.at("by_series_radius").get<double>());
  }
  std::fputc('\n', stderr);
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
        {"share", modelfile::reachingShare(positionsOf(data), data.contact_domain_radius, travel->travel)}};
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

void print(const Json& s) {
  std::fprintf(
      stderr,
      "%s: %zu nodes, %zu tetrahedra, %zu surface nodes; %zu contact positions, patch radius %.2f mm, ",
      s["method"].get<std::string>().c_str(), s["nodes"].get<std::size_t>(),
      s["tetrahedra"].get<std::size_t>(), s["surface_nodes"].get<std::size_t>(),
      s["contact_positions"].get<std::size_t>(), 1e3 * s["patch_radius"].get<double>());
  if (s.contains("order")) std::fprintf(stderr, "order %d, ", s["order"].get<int>());
  std::fprintf(stderr, "%zu modes\n", s["modes"].get<std::size_t>());
  printMesh(s);
  printTimes(s["seconds"]);
  printFit(s);
  printRadius(s);
  printTravel(s);
  printSize(s);
  printReach(s);
  std::fprintf(stderr, "model: %s, %.1f MB; peak memory %.0f MiB\n", s["model"].get<std::string>().c_str(),
               1e-6 * s["file_bytes"].get<double>(), s["peak_memory_MiB"].get<double>());
}

}  // namespace palpate::solve_program
