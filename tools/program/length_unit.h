// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::program {

/// A unit of length that a place may be given in.
struct LengthUnit {
  std::string_view word;    ///< what --unit takes
  std::string_view plural;  ///< in sentences
  double metres;
};
inline constexpr std::array<LengthUnit, 3> kLengthUnits{
    {{"m", "metres", 1.0}, {"cm", "centimetres", 1e-2}, {"mm", "millimetres", 1e-3}}};

/// The longest side of an organ: other lengths are told, with the unit suspected, m.
inline constexpr double kShortestOrgan = 0.005, kLongestOrgan = 1.0;
[[nodiscard]] constexpr bool isOrganLength(double metres) noexcept {
  return metres >= kShortestOrgan && metres <= kLongestOrgan;
}

/// What --unit takes.
[[nodiscard]] std::vector<std::string> lengthUnitWords();
/// @throw ValueError naming the word and those that are known
[[nodiscard]] const LengthUnit& lengthUnit(std::string_view word);

/// "63.2 m", "0.4 mm": metres from 1 m on.
[[nodiscard]] std::string lengthText(double metres);

using Point = std::array<double, 3>;

/// A place as it was asked for.
struct AskedPlace {
  std::string name;  ///< for the message: an option, or file, line and columns
  Point numbers{};   ///< in `unit`
  LengthUnit unit{kLengthUnits.front()};
  bool has_option{false};  ///< the program has --unit

  [[nodiscard]] Point inMetres() const { return inMetres(unit); }
  [[nodiscard]] Point inMetres(const LengthUnit& as) const {
    return {as.metres * numbers[0], as.metres * numbers[1], as.metres * numbers[2]};
  }
};

/// From a place in metres to the organ's surface, m; negative inside.
using SurfaceDistance = std::function<double(const Point&)>;

/// A place that lies farther from the surface than a tool's patch reaches means another unit, or another organ.
/// @param radius  of the patch, m
/// @throw ValueError naming the place, its distance, the radius, and a unit in which it would lie on the organ
void checkNear(const AskedPlace& place, double radius, const SurfaceDistance& distance);

}  // namespace palpate::program
