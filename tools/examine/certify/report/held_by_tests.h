// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace palpate::certify {

/// What palpate's own tests and studies hold against a closed form or another program, whatever the model.
struct HeldByTests {
  const char* what;
  const char* figure;  ///< as `file` has it
  const char* file;    ///< where it stands, with what it belongs to
  const char* command;
};

inline constexpr std::array<HeldByTests, 4> kHeldByTests{
    {{"Large bending of a beam, full Newton against CalculiX 2.20 (NLGEOM)",
      "agrees in every digit printed at 1 N", "docs/design.md", "ctest --preset release -R Beam.Tip"},
     {"Each node of a pressed block, both laws, full Newton against CalculiX's C3D10",
      "within 1e-5 of abs(d)", "docs/measured.md", "build/release/tests/query_validation"},
     {"A rigid flat punch, F = 2 E a delta / (1 - nu^2): quadratic elements are",
      "1.0 and 1.5 % too stiff at nu = 0.3 and 0.48", "docs/measured.md",
      "build/release/tests/solver_half_space_test"},
     {"1000 closed paths of a held tool: work over the largest stored energy", "-2.9e-7 to 8.9e-7",
      "docs/measured.md", "build/release/bin/palpate-feel loops MODEL"}}};

}  // namespace palpate::certify
