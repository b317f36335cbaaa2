// SPDX-License-Identifier: Apache-2.0
// The lines for a person.
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "tools/make/solve/summary.h"

namespace palpate::solve_program {

namespace {

using program::Json;

void printTimes(const Json& seconds) {
  std::string line = "time:";
  const std::pair<const char*, const char*> names[] = {{"factor", "factor"},
                                                       {"mesh_error", "the mesh's error"},
                                                       {"kept", "kept from an earlier run"},
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

/// What was chosen, and why.
void printChosen(const Json& s) {
  const Json* const chosen = s.find("chosen");
  if (chosen == nullptr) return;
  const auto why = [&](const char* key) { return chosen->at(key).at("why").get<std::string>(); };
  std::fprintf(stderr, "degrees of fields and force, %d and %d: %s\n", s["order"].get<int>(),
               s["force_order"].get<int>(), why("order").c_str());
  std::fprintf(stderr, "modes, %zu: %s\nnear field: %s\nmid-edges, %zu: %s\n", s["modes"].get<std::size_t>(),
               why("modes").c_str(), why("near_radius").c_str(),
               s["positions"].at("mid_edges").get<std::size_t>(), why("mid_edges").c_str());
}

/// How much of the file reaches the travel, side by side.
void printTravel(const Json& s) {
  const Json* const travel = s.find("travel");
  if (travel == nullptr) return;
  const double mm = 1e3 * travel->at("travel").get<double>(), touches = travel->at("touches").get<double>();
  std::fprintf(stderr,
               "touches of up to %.4g mm that are within d_max: %.0f %%; by the side that the surface faces:",
               mm, 100.0 * touches);
  for (std::size_t i = 0; i < s["sides"].size(); ++i) {
    const Json& side = s["sides"][i];
    std::fprintf(stderr, "%s %s %.0f %% (d_max %.2g mm)", i == 0 ? "" : ",",
                 side.at("side").get<std::string>().c_str(), 100.0 * side.at("touches").get<double>(),
                 1e3 * side.at("median").get<double>());
  }
  std::fputc('\n', stderr);
  if (touches < 0.5)
    std::fprintf(stderr,
                 "warning: of touches of up to %.4g mm only %.0f %% are within d_max; the model answers the "
                 "others too, "
                 "and flags them\n",
                 mm, 100.0 * touches);
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
  printChosen(s);
  printTravel(s);
  printSize(s);
  printReach(s);
  std::fprintf(stderr, "model: %s, %.1f MB; peak memory %.0f MiB\n", s["model"].get<std::string>().c_str(),
               1e-6 * s["file_bytes"].get<double>(), s["peak_memory_MiB"].get<double>());
}

}  // namespace palpate::solve_program
