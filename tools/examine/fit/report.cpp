// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/report.h"

#include <cmath>
#include <utility>

#include "tools/examine/fit/model_error.h"
#include "tools/program/printed.h"

namespace palpate::fit {

namespace {

using program::Json;
using program::printed;

/// As many digits as E is known to, for a command line.
std::string shortModulus(const Findings& found) {
  return printed("%.6g", found.E());
}

std::string regionLines(const Findings& found) {
  const ModelView& v = found.model.view();
  std::string text;
  for (std::size_t r = 0; r < v.region_name.size(); ++r)
    text += printed("  %-15s %.6g Pa (the model's: %.6g)\n", textOf(v.region_name[r]).c_str(),
                    found.estimate.scale.value * v.region_E[r], v.region_E[r]);
  return text.empty() ? text : "regions, scaled alike\n" + text;
}

std::string offsetLine(const Findings& found) {
  if (!found.options.find_offset) return "contact begins    at depth 0, as asked for\n";
  const auto [low, high] = found.offsetInterval();
  return printed("contact begins    at %.4g mm, %.4g to %.4g mm\n", 1e3 * found.estimate.offset.value,
                 1e3 * low, 1e3 * high);
}

std::string modulusLines(const Findings& found) {
  const auto [low, high] = found.interval();
  const Found& scale = found.estimate.scale;
  const double percent = 100.0 / scale.value;
  return printed("E                 %.6g Pa, %.6g to %.6g Pa with %g %% confidence\n", found.E(), low, high,
                 100.0 * found.options.confidence) +
         printed("                  +- %.3g %%: scatter %.3g %%, the model's own error %.3g %%%s\n",
                 percent * scale.halfWidth(), percent * scale.scatter, percent * scale.model,
                 found.certified ? "" : " (assumed)");
}

std::string residualsLine(const Findings& found) {
  const auto r_squared = found.rSquared();
  return printed("residuals         rms %.4g N, %.3g %% of the largest force", found.rmsResidual(),
                 100.0 * found.rmsResidual() / found.largestForce()) +
         (r_squared ? printed("; R2 %.6f\n", *r_squared) : "\n");
}

std::string serverLines(const Findings& found) {
  const std::string E = shortModulus(found);
  return "for a server      palpate-server --youngs-modulus " + E + ", or [organ] youngs_modulus = " + E +
         "\nwhile it runs     palpate-parameters --youngs-modulus " + E +
         (found.estimate.scale.value > 1.0 ? " (more than the model's: within its [limits])\n" : "\n");
}

Json pointsJson(const Findings& found) {
  Json list = Json::array();
  for (std::size_t i = 0; i < found.curve.points.size(); ++i) {
    const MeasuredPoint& point = found.curve.points[i];
    list.push_back({{"depth", point.depth},
                    {"force", point.force},
                    {"expected", found.estimate.expected[i]},
                    {"beyond_domain", found.press.at(point.depth - found.estimate.offset.value).beyond}});
  }
  return list;
}

Json placeJson(const Findings& found) {
  const ModelView& v = found.model.view();
  return {{"node", v.surface_mesh_tag[static_cast<std::size_t>(found.anchor.node)]},
          {"position", found.anchor.position},
          {"direction", found.direction},
          {"domain_radius", found.press.domainRadius()}};
}

Json regionsJson(const Findings& found) {
  const ModelView& v = found.model.view();
  Json regions = Json::object();
  for (std::size_t r = 0; r < v.region_name.size(); ++r)
    regions[textOf(v.region_name[r])] = found.estimate.scale.value * v.region_E[r];
  return regions;
}

// Warnings; empty where all is well.

std::string ofTheDomain(const Findings& found) {
  const Estimate& e = found.estimate;
  if (e.beyond == 0) return {};
  return printed(
      "%zu of %zu points in contact are deeper than d_max = %.4g mm, where the model's error is not "
      "bounded; --deepest leaves them out",
      e.beyond, e.in_contact, 1e3 * found.press.domainRadius());
}

std::string ofTheForm(const Findings& found) {
  if (!found.isOfAnotherForm()) return {};
  return printed(
      "the residuals change sign too seldom (probability %.2g): the measured curve has another form than "
      "the model's, and E may be off by more than its interval says",
      *found.runsProbability());
}

std::string ofTheModel(const Findings& found) {
  if (found.certified) return {};
  return printed(
      "the model is not certified: %g %% is taken for what its forces are off; palpate-certify finds it",
      100.0 * found.options.model.share);
}

std::string ofTheMesh(const Findings& found) {
  const auto mesh = meshError(found.model.attributes());
  const Found& scale = found.estimate.scale;
  if (!mesh || std::abs(*mesh) < scale.halfWidth() / scale.value) return {};
  return printed(
      "the mesh is too stiff by %.2g %%, more than the interval is wide: the organ's own E is about as "
      "much larger; with this model, the E that was found gives the measured forces",
      100.0 * *mesh);
}

std::string ofTheServer(const Findings& found) {
  constexpr double kLeast = 100.0, kMost = 1e9;  // Pa
  if (found.E() >= kLeast && found.E() <= kMost) return {};
  return printed("E = %.6g Pa is outside what a server takes: %g to %g Pa", found.E(), kLeast, kMost);
}

}  // namespace

Json toJson(const Findings& found) {
  const double model_E = found.model.attributes().E;
  const Estimate& e = found.estimate;
  const auto runs = found.runsProbability(), mesh = meshError(found.model.attributes()),
             r_squared = found.rSquared();
  return {{"E", found.E()},
          {"E_interval", found.interval()},
          {"confidence", found.options.confidence},
          {"E_standard_error", model_E * e.scale.standard_error},
          {"E_scatter", model_E * e.scale.scatter},
          {"E_model_error", model_E * e.scale.model},
          {"certified", found.certified},
          {"model_E", model_E},
          {"scale", e.scale.value},
          {"regions", regionsJson(found)},
          {"offset", e.offset.value},
          {"offset_interval", found.options.find_offset ? Json(found.offsetInterval()) : Json(nullptr)},
          {"points", found.curve.points.size()},
          {"in_contact", e.in_contact},
          {"beyond_domain", e.beyond},
          {"rms_residual", found.rmsResidual()},
          {"r_squared", r_squared ? Json(*r_squared) : Json(nullptr)},
          {"runs_probability", runs ? Json(*runs) : Json(nullptr)},
          {"other_form", found.isOfAnotherForm()},
          {"mesh_error", mesh ? Json(*mesh) : Json(nullptr)},
          {"place", placeJson(found)},
          {"measured_force", found.measured == Measured::kAlong ? "along" : "size"},
          {"warnings", warnings(found)},
          {"curve", pointsJson(found)}};
}

std::string toText(const Findings& found) {
  const Estimate& e = found.estimate;
  const Vec3& x = found.anchor.position;
  const Vec3& d = found.direction;
  return printed("model             E %.6g Pa, nu %.4g, %s, patch radius %.4g mm\n",
                 found.model.attributes().E, found.model.attributes().nu,
                 found.model.attributes().law.c_str(), 1e3 * found.model.attributes().patch_radius) +
         printed("place             %.6g, %.6g, %.6g m, pressed along %.4g, %.4g, %.4g\n", x.x(), x.y(),
                 x.z(), d.x(), d.y(), d.z()) +
         printed("curve             %zu points, %zu in contact, %zu beyond the domain of %.4g mm\n",
                 found.curve.points.size(), e.in_contact, e.beyond, 1e3 * found.press.domainRadius()) +
         modulusLines(found) + regionLines(found) + offsetLine(found) + residualsLine(found) +
         serverLines(found);
}

std::vector<std::string> warnings(const Findings& found) {
  std::vector<std::string> said;
  for (std::string sentence :
       {ofTheDomain(found), ofTheForm(found), ofTheModel(found), ofTheMesh(found), ofTheServer(found)})
    if (!sentence.empty()) said.push_back(std::move(sentence));
  return said;
}

}  // namespace palpate::fit
