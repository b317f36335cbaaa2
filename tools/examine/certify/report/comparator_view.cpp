// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/comparator_view.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tools/examine/certify/report/page_texts.h"
#include "tools/program/printed.h"

namespace palpate::certify {

using program::Json;
using program::printed;

namespace {

std::string vectorText(const Json& v, double factor, const char* format) {
  return printed(format, factor * v[0].get<double>(), factor * v[1].get<double>(),
                 factor * v[2].get<double>());
}

/// As a word of a shell's command line.
std::string shellWord(const std::string& text) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-";
  if (text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + '\'';
}

std::string pairsSentence(const Json& certificate) {
  const Json* const two = certificate.find("two_tools");
  if (two == nullptr)
    return "Not examined here (--two-tools). Near each other their answers are off by more than those of one "
           "tool.";
  std::string text = countText((*two)["samples"]) + " pairs were solved in full";
  if (!(*two)["force_error"].isNull())
    text += ": the force is off by " + percent((*two)["force_error"]["p95"]) + ", the field by " +
            percent((*two)["field_error"]["p95"]) + " (95 % quantiles)";
  const Json& least = (*two)["least_distance"];
  return text + (least.isNull() ? ". No distance is certified from which 1 % holds."
                                : ". From " + millimetres(least) + " on 1 % holds for 95 % of pairs.");
}

void addWorst(const Json& content, Json& view) {
  view["worst"] = Json::array();
  for (const auto& [by, key] : {std::pair("force", "force_error"), std::pair("field", "field_error")}) {
    std::vector<const Json*> touches;
    for (const Json& touch : content["touches"])
      if (touch["outcome"].text() == "within") touches.push_back(&touch);
    std::stable_sort(touches.begin(), touches.end(), [key = key](const Json* a, const Json* b) {
      return (*a)[key].get<double>() > (*b)[key].get<double>();
    });
    for (std::size_t i = 0; i < std::min<std::size_t>(3, touches.size()); ++i)
      view["worst"].push_back(
          {{"by", by},
           {"error", percent((*touches[i])[key])},
           {"position", vectorText((*touches[i])["position"], 1e3, "%.2f, %.2f, %.2f")},
           {"displacement", vectorText((*touches[i])["displacement"], 1e3, "%.2f, %.2f, %.2f")}});
  }
  const Json& worst = content["certificate"]["worst"]["force"];
  if (worst.isNull()) return;
  const char* const kVector = "%.6g,%.6g,%.6g";
  view["ask"] = "palpate-query " + shellWord(content["model"].text()) +
                " --at=" + vectorText(worst["position"], 1.0, kVector) +
                " --displacement=" + vectorText(worst["displacement"], 1.0, kVector) + " --newton";
}

}  // namespace

Json errorRow(const char* what, const Json& error) {
  Json out{{"what", what}};
  for (const char* key : {"p50", "p95", "max"}) out[key] = error.isNull() ? "none" : percent(error[key]);
  const Json* const bound = error.find("bound_95_95");
  out["bound"] = bound != nullptr && bound->isNumber() ? percent(*bound) : "no bound";
  return out;
}

void addComparatorView(const Json& content, Json& view) {
  const Json& c = content["certificate"];
  view["samples"] = countText(c["samples"]);
  view["drawn_sentence"] =
      countText(c["drawn"]) + " touches were drawn at random with the seed " + countText(c["seed"]) +
      ", uniform over the accessible area, the directions and the lengths; " + countText(c["beyond_domain"]) +
      " of them are beyond the model's domain, and of these " + countText(c["flagged"]["count"]) +
      " were solved too.";
  view["converged_sentence"] =
      c["not_converged"].get<int>() == 0
          ? std::string("All that were tried have a full solution.")
          : countText(c["not_converged"]) + " have no full solution and count as not certified.";
  view["errors"] = Json::array();
  view["errors"].push_back(errorRow("force", c["force_error"]));
  view["errors"].push_back(errorRow("field", c["field_error"]));
  const Json* const bound = c["force_error"].find("bound_95_95");
  view["bound_sentence"] = bound != nullptr && bound->isNumber()
                               ? "The bound is an order statistic and holds whatever the distribution; force "
                                 "and field each have that "
                                 "confidence by themselves."
                               : "No bound is claimed: it takes 59 touches in the domain, and there are " +
                                     countText(c["samples"]) + '.';
  view["det_sentence"] =
      c["min_det_f"].isNull()
          ? std::string()
          : printed("The smallest det F of the full solutions is %.3f; at 0 an element would be flat.",
                    c["min_det_f"].get<double>());
  view["pairs_sentence"] = pairsSentence(c);
  addWorst(content, view);
}

}  // namespace palpate::certify
