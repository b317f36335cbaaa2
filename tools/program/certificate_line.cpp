// SPDX-License-Identifier: Apache-2.0
#include "tools/program/certificate_line.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "tools/program/json.h"
#include "tools/program/printed.h"

namespace palpate::program {

namespace {

constexpr std::size_t kMostBytes = 65536;  // of a certificate in a model file
constexpr const char* kUnknown =
    "not certified: the certificate in the file has a form that this program does not know";

/// @throw JsonError  no number, or none in that range
double within(const Json& json, double least, double most) {
  const auto number = json.get<double>();
  if (!std::isfinite(number) || number < least || number > most) throw JsonError("JSON is out of range");
  return number;
}

/// @throw JsonError
std::uint64_t samplesOf(const Json& c) {
  constexpr double kMost = 2e6;
  const Json& samples = c.at("samples");
  if (!samples.isUnsigned()) throw JsonError("JSON is no count");
  return static_cast<std::uint64_t>(within(samples, 0.0, kMost));
}

/// Nothing where the certificate claims none. @throw JsonError
std::optional<double> boundOf(const Json& error) {
  if (error.isNull() || error.at("bound_95_95").isNull()) return {};
  return within(error.at("bound_95_95"), 0.0, std::numeric_limits<double>::max());
}

/// @throw JsonError
std::string lineOf(const Json& c) {
  constexpr std::uint64_t kLeastSamples = 59;  // docs/design.md, Certificate
  const std::uint64_t samples = samplesOf(c);
  const double travel = within(c.at("travel"), std::numeric_limits<double>::min(), 1.0),
               share = within(c.at("certified_area_fraction"), 0.0, 1.0);
  const std::optional<double> force = boundOf(c.at("force_error")), field = boundOf(c.at("field_error"));
  const bool bounds = samples >= kLeastSamples;
  if (force.has_value() != bounds || field.has_value() != bounds)
    throw JsonError("JSON has bounds that do not go with its samples");
  if (!bounds)
    return printed("not certified for touches to %.4g mm: %d samples in the domain, a bound takes 59",
                   1e3 * travel, static_cast<int>(samples));
  return printed(
      "certified for touches to %.4g mm: of touches in the domain, 95 %% are within %.2f %% in force and 95 "
      "%% "
      "within %.2f %% in field, each with 95 %% confidence; %.1f %% of touches are in the domain",
      1e3 * travel, 100.0 * *force, 100.0 * *field, 100.0 * share);
}

}  // namespace

std::string certificateLine(const std::string& certificate) {
  if (certificate.empty()) return "not certified: the model file does not state how far its answers are off";
  if (certificate.size() > kMostBytes) return kUnknown;  // to parse takes the square of its keys
  try {
    return lineOf(Json::parse(certificate));
  } catch (const JsonError&) {
    return kUnknown;
  }
}

}  // namespace palpate::program
