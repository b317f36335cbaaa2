// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palpate/client/surface.h"

namespace palpate::viewer {

/// Directions away from the organ: the area-weighted outward normal at the nearest node of the rest surface.
class Outward {
 public:
  Outward() = default;
  explicit Outward(const client::Surface& surface);

  /// @return unit direction; +z where there is no surface or it has no normal. Cost O(Ns). Threads: const, any.
  [[nodiscard]] device::Point at(const device::Point& p_W) const noexcept;

 private:
  std::vector<device::Point> positions_;
  std::vector<device::Point> normals_;  // unit, or zero
};

}  // namespace palpate::viewer
