// SPDX-License-Identifier: Apache-2.0
#include "tools/program/certificate_line.h"

#include "tools/program/json.h"
#include "tools/program/printed.h"

namespace palpate::program {

namespace {

/// Percent of one kind of error. @throw JsonError
std::string boundText(const Json& error) {
  const Json& bound = error.at("bound_95_95");
  if (bound.isNull()) return printed("%.2f %% at most seen", 100.0 * error.at("max").get<double>());
  return printed("%.2f %%", 100.0 * bound.get<double>());
}

/// @throw JsonError
std::string lineOf(const Json& c) {
  const bool bounded = !c.at("force_error").at("bound_95_95").isNull();
  return printed(
      "certified for touches to %.4g mm: force within %s, field within %s%s; %.1f %% of them are in the "
      "domain",
      1e3 * c.at("travel").get<double>(), boundText(c.at("force_error")).c_str(),
      boundText(c.at("field_error")).c_str(),
      bounded ? " for 95 % of them, with 95 % confidence"
              : printed(" in %d samples, too few for a bound", c.at("samples").get<int>()).c_str(),
      100.0 * c.at("certified_area_fraction").get<double>());
}

}  // namespace

std::string certificateLine(const std::string& certificate) {
  if (certificate.empty()) return "not certified: palpate-certify finds out how far its answers are off";
  try {
    return lineOf(Json::parse(certificate));
  } catch (const JsonError& error) {
    return std::string("certified by something else than palpate-certify: ") + error.what();
  }
}

}  // namespace palpate::program
