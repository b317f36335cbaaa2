// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/model_error.h"

#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>

#include "tools/program/json.h"

namespace palpate::fit {

namespace {

/// The finite number below these keys.
std::optional<double> numberIn(const std::string& text, std::initializer_list<std::string_view> keys) {
  const auto json = program::Json::read(text);
  const program::Json* at = json ? &*json : nullptr;
  for (const std::string_view key : keys)
    if (at != nullptr) at = at->find(key);
  if (at == nullptr || !at->isNumber() || !std::isfinite(at->get<double>())) return {};
  return at->get<double>();
}

constexpr double kFloor = 0.05;  // of the force at a travel, docs/design.md, Certificate

}  // namespace

std::optional<ModelError> certifiedError(const ModelAttributes& attributes, const Press& press) {
  const auto bound = numberIn(attributes.certificate, {"force_error", "bound_95_95"}),
             travel = numberIn(attributes.certificate, {"travel"});
  if (!bound || !travel || *bound < 0.0 || *travel < 0.0) return {};
  return ModelError{*bound, kFloor * press.at(*travel).force};
}

ModelError assumedError(const Press& press) {
  constexpr double kShare = 0.01;
  return {kShare, kFloor * press.at(press.domainRadius()).force};
}

std::optional<double> meshError(const ModelAttributes& attributes) {
  return numberIn(attributes.provenance, {"mesh_error", "mean"});
}

}  // namespace palpate::fit
