// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palpate/rt/cycle_stats.h"

namespace palpate::report {

/// A curve as text: `height` rows of block characters, each column the largest value of its share of the
/// samples, from 0 to the largest of all.
/// @param[in] x, y  as many each, x ascending; y not negative
[[nodiscard]] std::string textChart(const std::vector<double>& x, const std::vector<double>& y,
                                    const std::string& x_label, const std::string& y_label,
                                    std::size_t width = 72, std::size_t height = 8);

/// One line for each logarithmic bar: its range in us, its count, and a bar whose length is the logarithm of
/// the count, so that a single outlier shows.
[[nodiscard]] std::string textHistogram(const rt::CycleStats& histogram, int per_decade = 10);

}  // namespace palpate::report
