// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/examine/feel/contrast.h"

namespace palpate::feel {

/// The organ seen straight onto the largest contrast, coloured by contrast in per cent, with the regions' outlines: SVG.
/// @param[in] depth  of the presses, m
[[nodiscard]] std::string contrastSvg(const Pair& pair, const ContrastField& field,
                                      const std::vector<RegionContrast>& regions, double depth);

/// The surface with `contrast`, `force` and `force_without` (N), `beyond_domain` and `pressed` at its nodes, as VTK XML: 0 where
/// nothing was pressed.
[[nodiscard]] std::string contrastVtu(const Pair& pair, const ContrastField& field);

}  // namespace palpate::feel
