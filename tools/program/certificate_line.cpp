// SPDX-License-Identifier: Apache-2.0
#include "tools/program/certificate_line.h"

#include "tools/program/json.h"
#include "tools/program/printed.h"

namespace palpate::program {

namespace {

/// @throw JsonError
std::string lineOf(const Json& c) {
  const double mm = 1e3 * c.at("travel").get<double>(), share = c.at("certified_area_fraction").get<double>();
  const auto samples = c.at("samples").get<int>();
  const auto bound = [&](const char* error) { return c.at(error).find("bound_95_95"); };
  const Json *const force = bound("force_error"), *const field = bound("field_error");
  if (force == nullptr || field == nullptr || force->isNull() || field->isNull())
    return printed("not certified for touches to %.4g mm: %d samples in the domain, a bound takes 59", mm,
                   samples);
  return printed(
      "certified for touches to %.4g mm: force within %.2f %%, field within %.2f %% for 95 %% of them, with "
      "95 %% "
      "confidence; %.1f %% of them are in the domain",
      mm, 100.0 * force->get<double>(), 100.0 * field->get<double>(), 100.0 * share);
}

}  // namespace

std::string certificateLine(const std::string& certificate) {
  if (certificate.empty()) return "not certified: the model file does not state how far its answers are off";
  try {
    return lineOf(Json::parse(certificate));
  } catch (const JsonError&) {
    return "certified in a form that this program does not know";
  }
}

}  // namespace palpate::program
