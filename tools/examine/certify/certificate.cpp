// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/certificate.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

#include "tools/examine/certify/energy_asymmetry.h"
#include "tools/examine/certify/quantile_bound.h"
#include "tools/program/certificate_line.h"
#include "tools/program/printed.h"

namespace palpate::certify {

namespace {

using program::Json;
using program::printed;
using Error = double Finding::*;

/// Null without findings.
template <class One>
Json quantiles(const std::vector<One>& findings, double One::*error, bool bound) {
  if (findings.empty()) return nullptr;
  std::vector<double> errors;
  for (const One& finding : findings) errors.push_back(finding.*error);
  const ErrorStatistics s = statisticsOf(errors);
  Json json{{"p50", s.p50}, {"p95", s.p95}, {"max", s.max}};
  if (bound) json["bound_95_95"] = s.bound_95_95 ? Json(*s.bound_95_95) : Json(nullptr);
  return json;
}

/// The touch with the largest error, so that it can be asked for again.
Json worst(const std::vector<Finding>& findings, Error error) {
  if (findings.empty()) return nullptr;
  const Finding& f =
      *std::max_element(findings.begin(), findings.end(),
                        [error](const Finding& a, const Finding& b) { return a.*error < b.*error; });
  return {{"position", f.touch.position}, {"displacement", f.touch.d}, {"error", f.*error}};
}

template <class One>
Json leastDetF(const std::vector<One>& findings) {
  if (findings.empty()) return nullptr;
  return std::min_element(findings.begin(), findings.end(),
                          [](const One& a, const One& b) { return a.min_det_f < b.min_det_f; })
      ->min_det_f;
}

Json meshErrorOf(const MetaModel& model) {
  const auto provenance = Json::read(model.attributes().provenance);
  const Json* const error = provenance ? provenance->find("mesh_error") : nullptr;
  return error == nullptr ? Json(nullptr) : *error;
}

std::string errorText(const char* name, const Json& error) {
  if (error.isNull()) return {};
  const auto percent = [&](const char* key) { return 100.0 * error.at(key).get<double>(); };
  std::string text = printed("%-9s %.3f %% median, %.3f %% p95, %.3f %% largest", name, percent("p50"),
                             percent("p95"), percent("max"));
  const Json* const bound = error.find("bound_95_95");
  if (bound != nullptr && bound->isNull()) text += "; too few samples for a bound";
  if (bound != nullptr && !bound->isNull())
    text += printed("; 95 %% of touches within %.3f %%, with 95 %% confidence", percent("bound_95_95"));
  return text + '\n';
}

std::string pairsText(const Json& two) {
  std::string text =
      printed("two tools, %.1f to %.1f mm apart, %d pairs:\n", 1e3 * two["distance"]["from"].get<double>(),
              1e3 * two["distance"]["to"].get<double>(), two["samples"].get<int>());
  text += errorText("  force", two["force_error"]) + errorText("  field", two["field_error"]);
  if (two["samples"].get<std::size_t>() < kLeastSamples) return text + "  too few pairs for a bound\n";
  if (two["least_distance"].isNull()) return text + "  at no distance 1 % holds for 95 % of pairs\n";
  return text + printed("  from %.1f mm on 1 %% holds for 95 %% of pairs, with 95 %% confidence\n",
                        1e3 * two["least_distance"].get<double>());
}

/// Of all touches, those in the domain. Whether one is takes no full solution, so many more are asked than are examined.
double domainShare(const MetaModel& model, const Drawing& drawing) {
  constexpr int kAsked = 10'000;
  TouchSampler touches(model, drawing.range, drawing.seed);
  int within = 0;
  for (int i = 0; i < kAsked; ++i) within += isBeyond(model, touches.next()) ? 0 : 1;
  return static_cast<double>(within) / kAsked;
}

/// Of the examined touches in the domain, those with a full solution.
double solvedShare(const Examination& found) {
  const auto in_domain = std::count_if(found.findings.begin(), found.findings.end(),
                                       [](const Finding& finding) { return !finding.flagged; });
  return in_domain == 0 ? 0.0
                        : static_cast<double>(found.count(Outcome::kWithin)) / static_cast<double>(in_domain);
}

}  // namespace

Json certificateOf(const MetaModel& model, const Drawing& drawing, const Examination& found) {
  const std::vector<Finding> within = found.of(Outcome::kWithin), beyond = found.of(Outcome::kBeyond);
  Json c{{"program", "palpate-certify"},
         {"version", PALPATE_VERSION},
         {"samples", within.size()},
         {"drawn", found.findings.size()},
         {"beyond_domain", std::count_if(found.findings.begin(), found.findings.end(),
                                         [](const Finding& finding) { return finding.flagged; })},
         {"not_converged", found.count(Outcome::kNotSolved)},
         {"seed", drawing.seed},
         {"travel", drawing.travel.length}};
  c["force_error"] = quantiles(within, &Finding::force_error, true);
  c["field_error"] = quantiles(within, &Finding::field_error, true);
  c["min_det_f"] = leastDetF(within);
  c["certified_area_fraction"] = domainShare(model, drawing) * solvedShare(found);
  c["energy_asymmetry"] = energyAsymmetry(model);
  c["mesh_error"] = meshErrorOf(model);
  c["flagged"] = {{"count", beyond.size()},
                  {"force_error", quantiles(beyond, &Finding::force_error, false)},
                  {"field_error", quantiles(beyond, &Finding::field_error, false)}};
  c["worst"] = {{"force", worst(within, &Finding::force_error)},
                {"field", worst(within, &Finding::field_error)}};
  return c;
}

Json pairsOf(const MetaModel& model, const std::vector<PairFinding>& pairs) {
  constexpr double kAsked = 0.01;
  std::vector<PairFinding> solved;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(solved),
               [](const PairFinding& pair) { return pair.solved; });
  const auto flagged =
      std::count_if(pairs.begin(), pairs.end(), [](const PairFinding& pair) { return pair.flagged; });
  const double a = model.attributes().patch_radius;
  const std::optional<double> least = leastDistance(solved, a, kAsked);
  return {{"samples", solved.size()},
          {"drawn", pairs.size()},
          {"beyond_domain", flagged},
          {"not_converged", static_cast<std::ptrdiff_t>(pairs.size() - solved.size()) - flagged},
          {"distance", {{"from", kNearestPair * a}, {"to", kFarthestPair * a}}},
          {"force_error", quantiles(solved, &PairFinding::force_error, true)},
          {"field_error", quantiles(solved, &PairFinding::field_error, true)},
          {"min_det_f", leastDetF(solved)},
          {"least_distance", least ? Json(*least) : Json(nullptr)}};
}

Json touchesOf(const Examination& found) {
  Json list = Json::array();
  for (const Finding& f : found.findings) {
    const bool solved = f.outcome == Outcome::kWithin || f.outcome == Outcome::kBeyond;
    const auto ofSolved = [solved](double number) { return solved ? Json(number) : Json(nullptr); };
    list.push_back({{"position", f.touch.position},
                    {"displacement", f.touch.d},
                    {"beyond_domain", f.flagged},
                    {"outcome", toString(f.outcome)},
                    {"force_error", ofSolved(f.force_error)},
                    {"field_error", ofSolved(f.field_error)},
                    {"min_det_f", ofSolved(f.min_det_f)}});
  }
  return list;
}

std::string toText(const Json& c, const Drawing& drawing) {
  std::string text = printed("travel    %.4g mm (%s), seed %llu\n", 1e3 * drawing.travel.length,
                             drawing.travel.from.c_str(), static_cast<unsigned long long>(drawing.seed));
  text += printed(
      "touches   %d in the domain and solved, of %d drawn; %d beyond the domain, %d without a full "
      "solution\n",
      c["samples"].get<int>(), c["drawn"].get<int>(), c["beyond_domain"].get<int>(),
      c["not_converged"].get<int>());
  text += printed("certified %.1f %% of all touches, over area, directions and lengths\n",
                  100.0 * c["certified_area_fraction"].get<double>());
  text += errorText("force", c["force_error"]) + errorText("field", c["field_error"]);
  const Json& flagged = c["flagged"];
  if (flagged["count"].get<int>() > 0)
    text += printed("beyond the domain, %d touches:\n", flagged["count"].get<int>()) +
            errorText("  force", flagged["force_error"]) + errorText("  field", flagged["field_error"]);
  if (!c["min_det_f"].isNull()) text += printed("min det F %.3f\n", c["min_det_f"].get<double>());
  text += printed("energy    %.1e of the file's forces have none\n", c["energy_asymmetry"].get<double>());
  if (const Json* const mean = c["mesh_error"].find("mean"); mean != nullptr && mean->isNumber())
    text += printed("mesh      %.1f %% too stiff or too soft in the mean, beside the errors above\n",
                    100.0 * mean->get<double>());
  if (const Json* const two = c.find("two_tools")) text += pairsText(*two);
  return text;
}

}  // namespace palpate::certify
