// SPDX-License-Identifier: Apache-2.0
#include "tools/program/svg_axis.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/program/numbers.h"

namespace palpate::program {
namespace {

// A logarithmic axis gets the powers of ten, and 2 and 5 times those when they are few.
std::vector<double> logTicks(double low, double high) {
  const bool few = std::log10(high / low) < 2.5;
  std::vector<double> ticks;
  for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10.0)
    for (const double step : {1.0, 2.0, 5.0})
      if ((few || step < 1.5) && decade * step >= low && decade * step <= high)
        ticks.push_back(decade * step);
  return ticks;
}

}  // namespace

void Range::cover(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("a plot cannot show a number that is not finite");
  low = std::min(low, value);
  high = std::max(high, value);
}

double Axis::px(double value) const {
  const auto place = [this](double v) {
    return log ? std::log10(std::max(v, std::numeric_limits<double>::min())) : v;
  };
  return at_low + (at_high - at_low) * (place(value) - place(low)) / (place(high) - place(low));
}

Axis makeAxis(double low, double high, double at_low, double at_high, bool log) {
  if (!(low < high)) {  // nothing or one value: some room around it
    if (log) return makeAxis(low > 0.0 ? low / 2.0 : 1.0, low > 0.0 ? low * 2.0 : 10.0, at_low, at_high, log);
    const double room = std::max(std::abs(low), 1.0);
    return makeAxis(low - room / 2.0, low + room / 2.0, at_low, at_high, log);
  }
  if (log) return {low, high, at_low, at_high, true, logTicks(low, high)};
  std::vector<double> ticks = niceTicks(low, high, 6);
  const double from = std::min(low, ticks.front());
  const double upto = std::max(high, ticks.back());
  return {from, upto, at_low, at_high, false, std::move(ticks)};
}

}  // namespace palpate::program
