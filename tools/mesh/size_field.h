// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "tools/mesh/element_sizes.h"

namespace palpate::mesh {

/// Element sizes that Gmsh asks for while it lives. One at a time, inside a GmshSession.
class SizeField {
 public:
  /// @param size  of (dimension and number of the entity, place), m
  explicit SizeField(const std::function<double(int, int, const Eigen::Vector3d&)>& size);
  ~SizeField();
  SizeField(const SizeField&) = delete;
  SizeField& operator=(const SizeField&) = delete;
};

/// Sizes inside the surfaces of the current Gmsh model, which are meshed already.
[[nodiscard]] InnerSizes innerSizesOfModel(const ElementSizes& sizes);

}  // namespace palpate::mesh
