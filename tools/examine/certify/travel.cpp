// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/travel.h"

#include "tools/program/json.h"

namespace palpate::certify {

Travel travelOf(const ModelAttributes& attributes, std::optional<double> asked) {
  constexpr double kSoft = 50e3;                          // Pa
  constexpr double kSoftTravel = 0.007, kTravel = 0.005;  // m
  if (asked) return {*asked, "asked for"};
  const auto provenance = program::Json::read(attributes.provenance);
  const program::Json* const travel = provenance ? provenance->find("travel") : nullptr;
  if (travel != nullptr && travel->isNumber() && travel->get<double>() > 0.0)
    return {travel->get<double>(), "the case's"};
  if (attributes.E < kSoft) return {kSoftTravel, "the default below 50 kPa"};
  return {kTravel, "the default from 50 kPa on"};
}

}  // namespace palpate::certify
