// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/chosen.h"

#include <string>

#include "tools/program/printed.h"
#include "tools/solver/build/travel_orders.h"

namespace palpate::solve_program {

namespace {

using program::Json;
using program::printed;

Json choice(const Json& value, const std::string& why) {
  return {{"value", value}, {"why", why}};
}

/// "(3, 6): 81 %, (4, 6): 93 %".
std::string listOf(const solver::TravelOrders& travel) {
  std::string list;
  for (const solver::TriedOrders& one : travel.tried)
    list += printed("%s(%d, %d): %.0f %%", list.empty() ? "" : ", ", one.orders.fields, one.orders.answer,
                    100.0 * one.within);
  return list;
}

std::string whyOrders(const solver::Case& c, const solver::BuildReport& report) {
  if (!report.travel) return "given";
  const solver::TravelOrders& travel = *report.travel;
  const std::string touches =
      printed("touches of up to %.4g mm are within d_max at %d places", 1e3 * travel.travel, travel.places);
  if (c.order || c.force_order) return "given; of all " + touches + " " + listOf(travel);
  if (travel.within >= solver::kEnoughTouches)
    return "the least with which at least 90 % of all " + touches + ", by degrees of field and force " +
           listOf(travel);
  return "the most are within d_max: of all " + touches + ", by degrees of field and force " + listOf(travel);
}

std::string whyModes(const solver::Case& c, const solver::BuildReport& report) {
  if (c.modes) return "given";
  if (report.size) return "what the size limit has room for";
  return printed(
      "%s the largest error of the field over d is asked to be %.3g %% (p95), it is %.3g %%",
      report.fit_p95 <= report.fit_asked ? "as many as found to be enough:" : "the most there may be:",
      100.0 * report.fit_asked, 100.0 * report.fit_p95);
}

std::string whyNear(const solver::Case& c, const modelfile::ModelData& data) {
  if (c.near_radius) return "given";
  const double widths = data.attributes.near_radius / data.attributes.patch_radius;
  constexpr double kUsual = 4.51;
  if (widths < kUsual) return "4.5 patch radii";
  return printed("%.2g patch radii: with 4.5 the most modes miss the asked error", widths);
}

std::string whyEdges(const solver::Case& c, const solver::BuildReport& report) {
  const solver::EdgeChoice& edges = report.edges;
  if (c.handheld()) return "none: the field of a handheld model is less exact";
  if (edges.edges == 0) return "none: no edge is longer than 1.15 patch radii, or the fields are linear";
  const std::string tried = printed(
      "of %zu tried the second largest adds %.3g %% of d at a travel of %.4g mm, a quarter of the asked "
      "error is %.3g %%",
      edges.tried, 100.0 * edges.added, 1e3 * c.travelOrDefault(), 25.0 * c.fieldErrorOrDefault());
  return (edges.solved == 0 ? "none: " : "all that are longer than 1.15 patch radii: ") + tried;
}

}  // namespace

Json chosenOf(const solver::Case& c, const modelfile::ModelData& data, const solver::BuildReport& report) {
  const std::string orders = whyOrders(c, report);
  return {{"order", choice(data.attributes.order, orders)},
          {"force_order", choice(data.attributes.force_order, orders)},
          {"modes", choice(data.modes_X.size() / (3 * data.surface_mesh_tag.size()), whyModes(c, report))},
          {"near_radius", choice(data.attributes.near_radius, whyNear(c, data))},
          {"mid_edges", choice(report.edges.solved, whyEdges(c, report))}};
}

}  // namespace palpate::solve_program
