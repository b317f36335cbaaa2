// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace palpate::certify {

/// Draws, and solves what was drawn, until as many as asked for are in the domain and solved, at most 20 times as many draws.
/// Each round draws until as many as are missing lie in the domain.
/// @param next     draws one, with `flagged`: it is beyond the domain
/// @param solve    of a round's std::vector&, fills in what is found
/// @param counts   whether one is in the domain and solved
/// @return all that were drawn, in their order
template <class Next, class Solve, class Counts>
[[nodiscard]] auto drawAndSolve(std::size_t wanted, Next next, Solve solve, Counts counts) {
  constexpr std::size_t kMostDraws = 20;  // times wanted
  std::vector<decltype(next())> all;
  while (true) {
    const auto found = static_cast<std::size_t>(std::count_if(all.begin(), all.end(), counts));
    const std::size_t left = kMostDraws * wanted - all.size();
    if (found == wanted || left == 0) return all;
    decltype(all) drawn;
    for (std::size_t missing = wanted - found; missing > 0 && drawn.size() < left;) {
      drawn.push_back(next());
      if (!drawn.back().flagged) --missing;
    }
    solve(drawn);
    all.insert(all.end(), drawn.begin(), drawn.end());
  }
}

}  // namespace palpate::certify
