// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/place.h"

#include <algorithm>
#include <string>

#include "core/base/length.h"
#include "core/model/contact_radius.h"
#include "tools/program/numbers.h"
#include "tools/program/printed.h"

namespace palpate::query {

namespace {

Vec3 vectorOf(const program::Point& x) {
  return {x[0], x[1], x[2]};
}

double largestTravel(const MetaModel& model) {
  const auto& radius = model.view().contact_series_radius;
  return radius.empty() ? 0.0 : *std::max_element(radius.begin(), radius.end());
}

/// From corner to corner of the organ's box, m.
double sizeOf(const MetaModel& model) {
  const auto& x = model.view().surface_positions;
  Vec3 low = Vec3(x[0], x[1], x[2]), high = low;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
    const Vec3 X(x[i], x[i + 1], x[i + 2]);
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  return (high - low).norm();
}

/// The units in which the numbers are a touch within what the model is solved for; empty when there is none.
std::string suspicion(const MetaModel& model, const program::AskedPlace& asked) {
  const double travel = model.isDisplacementDriven() ? largestTravel(model) : longestDisplacement(model);
  std::string lengths, words;
  for (const program::LengthUnit& unit : program::kLengthUnits) {
    const double length = lengthOf(vectorOf(asked.inMetres(unit)));
    if (unit.metres >= asked.unit.metres || length > travel) continue;
    lengths += (lengths.empty() ? "; in " : ", in ") + std::string(unit.plural) + " it would be " +
               program::lengthText(length);
    words += (words.empty() ? ": --unit " : " or ") + std::string(unit.word);
  }
  return lengths + words;
}

}  // namespace

Anchor anchorOf(const MetaModel& model, const program::AskedPlace& place) {
  const program::Point asked = place.inMetres();
  const Anchor anchor = anchorNear(model, vectorOf(asked));
  program::checkNear(place, contactRadius(model), [&](const program::Point& x) {
    return x == asked ? *anchor.distance : model.surface().closestPoint(vectorOf(x)).signed_distance;
  });
  return anchor;
}

double longestDisplacement(const MetaModel& model) {
  const double size = sizeOf(model);
  return model.isDisplacementDriven() ? std::max(10.0 * largestTravel(model), 0.1 * size) : size;
}

Vec3 displacementOf(const MetaModel& model, const program::AskedPlace& asked) {
  const Vec3 d = vectorOf(asked.inMetres());
  const double longest = longestDisplacement(model), length = lengthOf(d);
  if (length <= longest) return d;
  throw program::ValueError(
      asked.name +
      program::printed(" %.9g,%.9g,%.9g ", asked.numbers[0], asked.numbers[1], asked.numbers[2]) +
      std::string(asked.unit.word) + " is " + program::lengthText(length) + " long, expected at most " +
      program::lengthText(longest) + " of an organ of " + program::lengthText(sizeOf(model)) +
      suspicion(model, asked));
}

}  // namespace palpate::query
