// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/types.h"
#include "core/data/region_surfaces.h"
#include "tools/picture/drawn_surface.h"

namespace palpate::picture {

/// What lies inside, drawn as a dashed outline.
struct Inside {
  std::string name;
  const RegionSurface* surface;
};

/// A place with a number, drawn where the eye sees it as a disc in the number's colour, or a square.
struct Mark {
  Vec3 X = Vec3::Zero();  ///< m
  double number{0.0};
  bool square{false};
};

/// A coloured surface with a bar of the colours, a bar of length and a legend, as one self-contained SVG that reads on light and on
/// dark ground. Borrows what it shows.
struct SurfacePicture {
  std::string title;      ///< may be empty
  std::string bar_label;  ///< what the numbers are, with their unit
  ColouredSurface surface;
  std::optional<Vec3> cross{};  ///< a place marked by a cross, m, where the eye sees it
  std::string cross_label{};
  std::vector<Inside> inside{};
  std::vector<Mark> marks{};
  double width{860.0};  ///< px; narrow ones are read on a phone

  [[nodiscard]] std::string svg() const;
};

}  // namespace palpate::picture
