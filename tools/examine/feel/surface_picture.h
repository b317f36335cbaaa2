// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/types.h"
#include "core/data/region_surfaces.h"
#include "tools/examine/feel/drawn_surface.h"

namespace palpate::feel {

/// What lies inside, drawn as a dashed outline.
struct Inside {
  std::string name;
  const RegionSurface* surface;
};

/// A coloured surface with a bar of the colours, a bar of length and a legend, as one self-contained SVG that reads on light and on
/// dark ground. Borrows what it shows.
struct SurfacePicture {
  std::string title;
  std::string bar_label;  ///< what the numbers are, with their unit
  ColouredSurface surface;
  Vec3 cross = Vec3::Zero();  ///< a place marked by a cross, m
  std::string cross_label;
  std::vector<Inside> inside;

  [[nodiscard]] std::string svg() const;
};

}  // namespace palpate::feel
