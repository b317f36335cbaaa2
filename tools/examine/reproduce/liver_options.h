// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace palpate::reproduce {

struct LiverOptions {
  std::filesystem::path mesh;         ///< empty: the paper's liver
  double element_size{0.0067};        ///< m, of the paper's liver
  double coarse_element_size{0.016};  ///< m, of the liver-like organ for the ten terms; 0: leave it out
  std::vector<int> pairs{20, 50, 100, 167, 300};
  int samples{59};  ///< held-out points; their maximum bounds the 95 % quantile with 95 % confidence
  int steps{30};    ///< load steps of the ten terms
  int workers{1};
};

}  // namespace palpate::reproduce
