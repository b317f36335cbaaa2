// SPDX-License-Identifier: Apache-2.0
#include "tools/program/spread.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace palpate::program {

std::vector<double> spread(const std::vector<double>& wanted, double low, double high, double gap) {
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return wanted[a] < wanted[b]; });
  std::vector<double> place(wanted.size());
  double least = low;
  for (const std::size_t i : order) {
    place[i] = std::max(wanted[i], least);
    least = place[i] + gap;
  }
  double most = high;
  for (auto i = order.rbegin(); i != order.rend(); ++i) {
    place[*i] = std::min(place[*i], most);
    most = place[*i] - gap;
  }
  return place;
}

}  // namespace palpate::program
