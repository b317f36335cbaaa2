// SPDX-License-Identifier: Apache-2.0
#include "page_message.h"

#include <cmath>

#include "tools/program/json.h"

namespace palpate::viewer {
namespace {

using program::Json;

// A finite number in [low, high].
std::optional<double> number(const Json& object, const char* key, double low, double high) {
  const Json* const at = object.find(key);
  if (at == nullptr || !at->isNumber()) return std::nullopt;
  const double value = at->get<double>();
  if (!(value >= low && value <= high)) return std::nullopt;
  return value;
}

// A whole number in [0, high].
std::optional<std::uint64_t> whole(const Json& object, const char* key, std::uint64_t high) {
  const Json* const at = object.find(key);
  if (at == nullptr || !at->isUnsigned()) return std::nullopt;
  const auto value = at->get<std::uint64_t>();
  if (value > high) return std::nullopt;
  return value;
}

std::optional<PageMessage> target(const Json& object) {
  const Json* const at = object.find("position");
  if (at == nullptr || !at->isArray() || at->size() != 3) return std::nullopt;
  Target result{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(*at)[i].isNumber()) return std::nullopt;
    result.position[i] = (*at)[i].get<double>();
    if (!(std::fabs(result.position[i]) <= kMaxCoordinate)) return std::nullopt;
  }
  return result;
}

std::optional<PageMessage> parameters(const Json& object) {
  constexpr std::uint64_t kMaxExact = 1ULL << 53;  // a page's numbers are exact up to here
  constexpr double kLargest = 1e12;                // the server judges the ranges
  const auto request = whole(object, "request", kMaxExact);
  if (!request) return std::nullopt;
  SetParameters result{};
  result.request = *request;
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const bool factor =
        kLiveParameters[i]
            .zero_is_models;  // times the model's E; 0 is refused: on the wire it means the model's own
    const char* const key = factor ? "youngs_factor" : kLiveParameters[i].name;
    if (!object.contains(key)) continue;
    const auto value = number(object, key, factor ? 1e-6 : 0.0, kLargest);
    if (!value) return std::nullopt;
    result.*kLiveFields<SetParameters>[i] = value;
  }
  return result;
}

}  // namespace

std::optional<PageMessage> parsePageMessage(std::string_view text) {
  if (text.size() > kMaxMessage) return std::nullopt;
  const std::optional<Json> read = Json::read(text);
  if (!read) return std::nullopt;
  const Json& object = *read;
  const Json* const type = object.find("type");  // nothing in what is no object
  if (type == nullptr || !type->isString()) return std::nullopt;
  const std::string& name = type->text();
  if (name == "ack") {
    const auto seq = whole(object, "seq", UINT32_MAX);
    return seq ? std::optional<PageMessage>(Ack{static_cast<std::uint32_t>(*seq)}) : std::nullopt;
  }
  if (name == "ping") {
    const auto t0 = number(object, "t0", -1e18, 1e18);
    return t0 ? std::optional<PageMessage>(Ping{*t0}) : std::nullopt;
  }
  if (name == "rate") {
    const auto hz = number(object, "hz", 0.0, 1000.0);
    return hz ? std::optional<PageMessage>(SetRate{*hz}) : std::nullopt;
  }
  if (name == "grab") return Grab{};
  if (name == "release") return Release{};
  if (name == "target") return target(object);
  if (name == "set") return parameters(object);
  return std::nullopt;
}

}  // namespace palpate::viewer
