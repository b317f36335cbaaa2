// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

namespace palpate::fit {

/// How probable so few runs of one sign are, where signs follow each other by chance: near 0 where a curve passes its points
/// on one side and then on the other. A. Wald, J. Wolfowitz, Ann. Math. Stat. 11 (1940) 147-162, by their normal limit.
/// @param residuals  in the order of depth; zeros are left out  @return nothing below 10 of either sign
[[nodiscard]] std::optional<double> probabilityOfRuns(std::span<const double> residuals);

}  // namespace palpate::fit
