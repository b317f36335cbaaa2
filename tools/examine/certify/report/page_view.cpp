// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/page_view.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include "tools/examine/certify/report/comparator_view.h"
#include "tools/examine/certify/report/data_uri.h"
#include "tools/examine/certify/report/page_texts.h"
#include "tools/program/printed.h"

namespace palpate::certify {

namespace {

using program::Json;
using program::printed;

Json row(const char* what, std::string value) {
  return {{"what", what}, {"value", std::move(value)}};
}

Json figureList(const std::vector<Figure>& figures) {
  Json list = Json::array();
  for (const Figure& figure : figures)
    list.push_back({{"source", dataUri("image/svg+xml", figure.svg)},
                    {"alternative", figure.alternative},
                    {"caption", figure.caption}});
  return list;
}

void addContext(const Json& content, Json& view) {
  const Json& context = content["context_of_use"];
  const Json& made = context["made"];
  const double accessible = context["accessible_area"].get<double>();
  view["identity"] = Json::array();
  view["identity"].push_back(row("Model", content["model_id"].text()));
  view["identity"].push_back(row("SHA-256 of its content", content["sha256"].text()));
  std::string directions =
      context["inward"].get<bool>() ? "in directions into the organ" : "in any direction";
  if (!context["length"].isNull()) directions += ", all by " + millimetres(context["length"]);
  view["context"] = {{"travel", millimetres(context["travel"])},
                     {"travel_from", context["travel_from"]},
                     {"directions", directions},
                     {"accessible", printed("%.4g cm\u00b2", 1e4 * accessible)},
                     {"share", percent(accessible / context["surface_area"].get<double>())}};
  view["made"] = Json::array();
  for (const auto& [what, key] : {std::pair("Mesh", "mesh"), std::pair("SHA-256 of the mesh", "mesh_hash"),
                                  std::pair("Method", "method"), std::pair("Program", "program"),
                                  std::pair("Version", "version"), std::pair("When", "created")})
    view["made"].push_back(row(what, known(made[key])));
  if (known(made["case"]) != "unknown") view["case"] = made["case"];
}

void addVerification(const Json& content, Json& view) {
  const Json& checks = content["code_verification"]["in_place"];
  const auto number = [&](const char* key) { return printed("%.1e", checks[key].get<double>()); };
  view["checks"] = {{"rotation", number("rotation")},
                    {"resultant", number("resultant")},
                    {"energy", number("energy_asymmetry")}};
  view["held"] = content["code_verification"]["held_by_tests"];
}

void addMesh(const Json& content, Json& view) {
  const Json& mesh = content["mesh"];
  const double edge = mesh["median_contact_edge"].get<double>(), a = mesh["patch_radius"].get<double>();
  view["mesh"] = Json::array();
  view["mesh"].push_back(row("Elements", countText(mesh["tetrahedra"]) +
                                             (mesh["element_order"].get<int>() == 2 ? " quadratic tetrahedra"
                                                                                    : " linear tetrahedra")));
  view["mesh"].push_back(row("Nodes", countText(mesh["nodes"])));
  view["mesh"].push_back(row("Nodes on the surface", countText(mesh["surface_nodes"])));
  view["mesh"].push_back(row("Places where the series is solved", countText(mesh["contact_positions"])));
  view["mesh"].push_back(row("Median edge where tools press",
                             printed("%.3g mm, %.2g of the patch's width a", 1e3 * edge, edge / a)));
  view["patch"] = millimetres(mesh["patch_radius"]);
  const Json& error = mesh["mesh_error"];
  const Json *const mean = error.find("mean"), *const most = error.find("max"),
                    *const against = error.find("against");
  const bool measured = mean != nullptr && mean->isNumber() && most != nullptr && most->isNumber();
  view["mesh_error"] =
      measured ? "Against " + known(against == nullptr ? Json(nullptr) : *against) + " the mesh is off by " +
                     percent(*mean) + " in the mean of the points and by " + percent(*most) +
                     " at most, in the stiffness felt. That comes on top of the errors in part 6."
               : "How far the mesh is off is unknown: the solver was not asked (palpate-solve --mesh-error). "
                 "The errors "
                 "in part 6 do not contain it.";
}

void addForm(const Json& content, Json& view) {
  const Json& form = content["model_form"];
  view["materials"] = Json::array();
  const auto add = [&](const std::string& name, const Json& material) {
    view["materials"].push_back({{"name", name},
                                 {"law", material["law"]},
                                 {"E", printed("%.4g kPa", 1e-3 * material["E"].get<double>())},
                                 {"nu", printed("%.4g", material["nu"].get<double>())}});
  };
  if (form["regions"].empty()) add("the organ", form);
  for (const Json& region : form["regions"]) add(region["name"].text(), region);
  view["held_at"] = "It is held at " + countText(content["mesh"]["fixed_nodes"]) + " clamped nodes";
  if (form["springs"]["nodes"].get<int>() > 0)
    view["held_at"] = view["held_at"].text() + " and by springs at " + countText(form["springs"]["nodes"]) +
                      " nodes, " + printed("%.4g N/m in all", form["springs"]["stiffness"].get<double>());
  view["held_at"] = view["held_at"].text() + '.';
  for (const char* key : {"order", "force_order", "modes"}) view[key] = countText(form[key]);
}

void addUncertainty(const Json& content, Json& view) {
  const Json& error = content["uncertainty"]["youngs_modulus_error"];
  std::string text =
      "At a given displacement the force is proportional to E, if the E of all parts are off by the same "
      "share: 10 % in E "
      "are 10 % in the force. The field does not depend on E then. ";
  if (content["model_form"]["springs"]["nodes"].get<int>() > 0)
    text +=
        "The springs that hold the organ do not change with E, so the true change is smaller, and the field "
        "changes a "
        "little. ";
  text += error.isNull()
              ? "How well E is known was not given (--youngs-modulus-error), so the curves have no band."
              : "The band is the force with E off by " + percent(error) + " either way, as it was given.";
  view["modulus_sentence"] = text;
}

void addApplicability(const Json& content, Json& view) {
  const Json& c = content["certificate"];
  const Json& travel = content["context_of_use"]["travel"];
  view["area_sentence"] =
      "Of all touches, over area, directions and lengths together, " + percent(c["certified_area_fraction"]) +
      " are in the domain and have a full solution: the errors of part 6 are about these.";
  view["reach"] = Json::array();
  for (const Json& one : content["applicability"]["reach"])
    view["reach"].push_back({{"travel", millimetres(one["travel"])}, {"share", percent(one["share"])}});
  const bool flagged = c["flagged"]["count"].get<int>() > 0;
  view["beyond_sentence"] =
      "Beyond d_max(s) the model still answers, and flags it. The server passes the flag on. " +
      (flagged ? "Of the touches up to " + millimetres(travel) + " beyond the domain " +
                     countText(c["flagged"]["count"]) + " were solved in full. Nothing is promised for them."
               : std::string("No touch beyond the domain was solved, so nothing is known there."));
  view["has_flagged"] = flagged;
  view["flagged"] = Json::array();
  view["flagged"].push_back(errorRow("force", c["flagged"]["force_error"]));
  view["flagged"].push_back(errorRow("field", c["flagged"]["field_error"]));
}

std::string stiffnessText(const Json& surface) {
  std::vector<double> numbers;
  for (const Json& number : surface["normal_stiffness"])
    if (number.isNumber()) numbers.push_back(number.get<double>());
  if (numbers.empty()) return "no place is accessible";
  std::sort(numbers.begin(), numbers.end());
  return printed("%.4g at the softest place, %.4g in the median, %.4g at the stiffest", numbers.front(),
                 numbers[numbers.size() / 2], numbers.back());
}

}  // namespace

Json pageViewOf(const Json& content, const Figures& figures) {
  Json view{{"model", std::filesystem::path(content["model"].text()).filename().string()},
            {"version", content["version"]},
            {"status", content["status"]},
            {"stiffness", stiffnessText(content["surface"])}};
  addContext(content, view);
  addVerification(content, view);
  addMesh(content, view);
  addForm(content, view);
  addComparatorView(content, view);
  addUncertainty(content, view);
  addApplicability(content, view);
  view["stiffness_figures"] = figureList(figures.stiffness);
  view["force_figures"] = figureList(figures.force_error);
  view["field_figures"] = figureList(figures.field_error);
  view["length_figures"] = figureList(figures.errors_by_length);
  view["curve_figures"] = figureList(figures.curves);
  view["reach_figures"] = figureList(figures.reach);
  return view;
}

}  // namespace palpate::certify
