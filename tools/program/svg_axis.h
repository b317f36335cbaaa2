// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

namespace palpate::program {

/// The values that an axis shows.
struct Range {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};
  /// @throw std::invalid_argument when it is not finite
  void cover(double value);
};

/// One axis of a plot: from its values to pixels.
struct Axis {
  double low, high;
  double at_low, at_high;  ///< px
  bool log;
  std::vector<double> ticks;

  [[nodiscard]] double px(double value) const;
};

/// An axis from at_low to at_high, px, that shows low to high, rounded to ticks where it is linear. Around one value it has
/// some room. @param log  low and high are above 0 then, or become so
[[nodiscard]] Axis makeAxis(double low, double high, double at_low, double at_high, bool log);

}  // namespace palpate::program
