// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace palpate::program {

/// Places at least `gap` apart and within [low, high], in the order of `wanted`, each as near to where it is wanted as its
/// neighbours let it: pushed up from the first to the last, then down where the last went beyond `high`.
/// @param[in] wanted  any order  @return places in that order. Where there is no room for all, they go below `low`
[[nodiscard]] std::vector<double> spread(const std::vector<double>& wanted, double low, double high,
                                         double gap);

}  // namespace palpate::program
