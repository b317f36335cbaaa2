// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "page_message.h"
#include "targets.h"

bool palpate::fuzz::page(Bytes input) {
  const auto message = viewer::parsePageMessage({reinterpret_cast<const char*>(input.data()), input.size()});
  if (!message) return false;
  if (const auto* target = std::get_if<viewer::Target>(&*message))
    for (const double x : target->position)
      require(std::fabs(x) <= viewer::kMaxCoordinate, "a target is near");
  if (const auto* rate = std::get_if<viewer::SetRate>(&*message))
    require(rate->hz >= 0.0 && rate->hz <= 1000.0, "a rate is in its range");
  if (const auto* set = std::get_if<viewer::SetParameters>(&*message))
    for (const auto field : kLiveFields<viewer::SetParameters>) {
      const std::optional<double>& value = set->*field;
      require(!value || (*value >= 0.0 && std::isfinite(*value)), "a parameter is a number");
    }
  return true;
}
