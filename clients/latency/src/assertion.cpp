// SPDX-License-Identifier: Apache-2.0
#include "assertion.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "tools/program/numbers.h"
#include "tools/program/printed.h"
#include "tools/program/xml.h"

namespace palpate::latency {
namespace {

using Relation = Assertion::Relation;

constexpr std::array<std::pair<std::string_view, Relation>, 6> kRelations{{{"<=", Relation::kAtMost},
                                                                           {">=", Relation::kAtLeast},
                                                                           {"==", Relation::kEqual},
                                                                           {"!=", Relation::kUnequal},
                                                                           {"<", Relation::kLess},
                                                                           {">", Relation::kMore}}};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

bool readBound(std::string_view text, double& bound) {
  if (text == "true" || text == "false") {
    bound = text == "true" ? 1.0 : 0.0;
    return true;
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bound);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(bound);
}

/// The value at a path; null pointer: there is none.
const program::Json* valueAt(const program::Json& report, std::string_view path) {
  const program::Json* value = &report;
  while (value != nullptr) {
    const std::size_t dot = path.find('.');
    value = value->find(path.substr(0, dot));
    if (dot == std::string_view::npos) return value;
    path.remove_prefix(dot + 1);
  }
  return nullptr;
}

/// Paths of all figures below `value`, joined by ", ".
std::string pathsOf(const program::Json& value, const std::string& prefix) {
  std::string all;
  for (const auto& [key, member] : value.members()) {
    const std::string path = prefix.empty() ? key : prefix + "." + key;
    const bool figure = member.isNumber() || member.isBool();
    if (!figure && !member.isObject()) continue;
    all += (all.empty() ? "" : ", ") + (figure ? path : path + ".*");
  }
  return all;
}

/// What may stand in the place of a path that is not there: the keys of the last object that it reaches.
std::string instead(const program::Json& shape, const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot != std::string::npos)
    if (const program::Json* parent = valueAt(shape, path.substr(0, dot));
        parent != nullptr && parent->isObject())
      return pathsOf(*parent, path.substr(0, dot));
  if (const program::Json* itself = valueAt(shape, path); itself != nullptr && itself->isObject())
    return pathsOf(*itself, path);
  return pathsOf(shape, "");
}

bool holds(double found, Relation relation, double bound) {
  switch (relation) {
    case Relation::kLess:
      return found < bound;
    case Relation::kAtMost:
      return found <= bound;
    case Relation::kEqual:
      return found == bound;
    case Relation::kUnequal:
      return found != bound;
    case Relation::kAtLeast:
      return found >= bound;
    case Relation::kMore:
      return found > bound;
  }
  return false;
}

/// Whether a figure is a quantile of nothing: its object counts no value.
bool ofNothing(const program::Json& report, const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos || path.substr(dot + 1) == "count") return false;
  const program::Json* parent = valueAt(report, path.substr(0, dot));
  const program::Json* count = parent == nullptr ? nullptr : parent->find("count");
  return count != nullptr && count->get<double>() == 0.0;
}

}  // namespace

Assertion parseAssertion(const std::string& text, const program::Json& shape) {
  const std::string is = "--assert " + text + ": ";
  const std::size_t at = text.find_first_of("<>=!");
  const auto* relation = std::find_if(kRelations.begin(), kRelations.end(), [&](const auto& one) {
    return at != std::string::npos && text.compare(at, one.first.size(), one.first) == 0;
  });
  if (relation == kRelations.end())
    throw program::ValueError(is + "expected FIGURE, one of < <= == != >= >, and a number, as in 'lost==0'");
  Assertion assertion{text, std::string(trimmed(text.substr(0, at))), relation->second, 0.0};
  const std::string_view bound = trimmed(std::string_view(text).substr(at + relation->first.size()));
  if (!readBound(bound, assertion.bound))
    throw program::ValueError(is + "'" + std::string(bound) + "' is not a number, true or false");
  const program::Json* value = valueAt(shape, assertion.path);
  if (value == nullptr || !(value->isNumber() || value->isBool()))
    throw program::ValueError(is + "no figure '" + assertion.path + "'; there are " +
                              instead(shape, assertion.path));
  return assertion;
}

Outcome judge(const Assertion& assertion, const program::Json& report) {
  const program::Json* value = valueAt(report, assertion.path);
  if (value == nullptr || value->isNull() || ofNothing(report, assertion.path))
    return {assertion, false, "not measured"};
  const double found = value->isBool() ? (value->get<bool>() ? 1.0 : 0.0) : value->get<double>();
  return {assertion, holds(found, assertion.relation, assertion.bound), value->dump()};
}

Outcome judgeEach(const Assertion& assertion, const std::vector<program::Json>& tools) {
  Outcome outcome;
  for (const program::Json& report : tools) {
    outcome = judge(assertion, report);
    if (tools.size() > 1) outcome.found += " of tool " + report["tool_id"].dump();
    if (!outcome.held) return outcome;
  }
  if (tools.size() > 1) outcome.found = "held by each of " + std::to_string(tools.size()) + " tools";
  return outcome;
}

std::string failureLine(const Outcome& outcome) {
  return "assertion failed: " + outcome.assertion.text + ": it is " + outcome.found;
}

std::string junitOf(const std::vector<Outcome>& outcomes, double seconds) {
  const auto failed =
      std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return !o.held; });
  const std::string time = program::printed("%.3f", seconds);
  const std::string counts = "tests=\"" + std::to_string(outcomes.size()) + "\" failures=\"" +
                             std::to_string(failed) + "\" errors=\"0\" time=\"" + time + "\"";
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites " + counts +
                    ">\n<testsuite name=\"" + "palpate-latency\" " + counts + ">\n";
  for (const Outcome& outcome : outcomes) {
    xml += "<testcase classname=\"palpate-latency\" name=\"" + program::xmlEscaped(outcome.assertion.text) +
           "\" time=\"" + time + "\">\n";
    if (outcome.held)
      xml += "<system-out>" + program::xmlEscaped(outcome.found) + "</system-out>\n";
    else
      xml += "<failure message=\"" + program::xmlEscaped(failureLine(outcome)) + "\"/>\n";
    xml += "</testcase>\n";
  }
  return xml + "</testsuite>\n</testsuites>\n";
}

}  // namespace palpate::latency
