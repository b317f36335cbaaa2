// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/travel.h"

#include "tools/examine/certify/certify_error.h"
#include "tools/modelfile/default_travel.h"
#include "tools/program/json.h"
#include "tools/program/printed.h"

namespace palpate::certify {

namespace {

double checked(const program::Json& travel) {
  const bool good =
      travel.isNumber() && travel.get<double>() >= kShortestTravel && travel.get<double>() <= kLongestTravel;
  if (!good)
    throw CertifyError("attribute provenance, /travel is " + travel.dump().substr(0, 40) +
                       program::printed(", expected %g to %g m", kShortestTravel, kLongestTravel));
  return travel.get<double>();
}

}  // namespace

Travel travelOf(const ModelAttributes& attributes, std::optional<double> asked) {
  if (asked) return {*asked, "asked for"};
  const auto provenance = program::Json::read(attributes.provenance);
  const program::Json* const travel = provenance ? provenance->find("travel") : nullptr;
  if (travel != nullptr) return {checked(*travel), "what it was solved for"};
  return {modelfile::defaultTravel(attributes.E), "the default of this stiffness"};
}

}  // namespace palpate::certify
