// SPDX-License-Identifier: Apache-2.0
#include "palpate/report/asked_place.h"

#include <iostream>

#include "palpate/client/place.h"
#include "tools/program/length_unit.h"
#include "tools/program/numbers.h"

namespace palpate::report {

std::optional<device::Point> askedPlace(const client::Surface& surface, const std::string& option,
                                        const std::string& text) {
  if (text.empty()) return {};
  const device::Point place{program::parseVector(option, text)};
  double away = 0.0;
  program::checkNear({option, place}, client::contactRadius(surface), [&](const program::Point& x) {
    return away = client::distanceTo(surface, device::Point{x});
  });
  std::cerr << option << " lies " << program::lengthText(away) << " from the organ's surface\n";
  return place;
}

std::string neverTouchedText(double nearest) {
  return "the tool never touched the organ: its centre stayed at least " + program::lengthText(nearest) +
         " from the surface; poses are in metres";
}

}  // namespace palpate::report
