// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "targets.h"
#include "tools/solver/build/case_file.h"

bool palpate::fuzz::cases(Bytes input) {
  try {
    const solver::Case c = solver::parseCase("folder/case.toml", std::string(input.begin(), input.end()));
    require(c.E > 0.0 && c.E <= 1e12 && c.nu >= -0.99 && c.nu <= 0.4999, "the material is in its range");
    require(std::all_of(c.regions.begin(), c.regions.end(), [](const auto& r) { return r.E > 0.0; }),
            "regions have a stiffness");
    solver::checkCase(c);
  } catch (const solver::CaseError&) {
    return false;
  }
  return true;
}
