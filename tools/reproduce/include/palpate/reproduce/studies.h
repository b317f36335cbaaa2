// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "palpate/reproduce/output.h"

namespace palpate::reproduce {

struct RodOptions {
  int elements{40};                                         ///< linear elements, >= 1
  std::vector<int> steps{10, 20, 50, 100, 200, 500, 1000};  ///< load steps; the last is the finest
  int workers{1};
};

struct BeamOptions {
  double load{1.0};       ///< N, downward, > 0
  int steps{100};         ///< load steps, >= 1
  double tolerance{0.1};  ///< of the residual of a step, relative, energy norm, worst position, > 0
  std::array<int, 3> nodes{21, 9, 9};  ///< along 400 x 40 x 40 mm, each >= 2
  int workers{1};
};

struct LiverOptions {
  std::filesystem::path mesh;         ///< empty: the default organ
  double element_size{0.0067};        ///< m, of the default organ
  double coarse_element_size{0.016};  ///< m, of the liver-like organ for the ten terms; 0: leave it out
  std::vector<int> pairs{20, 50, 100, 167, 300};
  int samples{59};  ///< held-out points; their maximum bounds the 95 % quantile with 95 % confidence
  int steps{30};    ///< load steps of the ten terms
  int workers{1};
};

/// Section 4.1 and Figure 1. Writes its figures and tables to `out`. @return what results.json is to hold
[[nodiscard]] Json reproduceRod(const RodOptions& options, Output& out);
/// Section 4.2, Figures 2 to 4. @throw std::runtime_error when a solver fails
[[nodiscard]] Json reproduceBeam(const BeamOptions& options, Output& out);
/// Section 4.3, Figures 5 to 7. @throw mesh::MeshError, std::runtime_error
[[nodiscard]] Json reproduceLiver(const LiverOptions& options, Output& out);

}  // namespace palpate::reproduce
