// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/model/meta_model.h"

namespace palpate::certify {

/// What a hand would meet at each surface node, [Ns]; nothing where no tool may be.
struct SurfaceMaps {
  std::vector<std::optional<double>> domain_radius;     ///< d_max, m
  std::vector<std::optional<double>> normal_stiffness;  ///< n . df/dd n at rest, N/m

  /// The node whose stiffness is the median of those with a contact position. @param model  what the maps are of
  /// @return nothing where none is accessible
  [[nodiscard]] std::optional<std::size_t> typicalNode(const MetaModel& model) const;
};

/// As respond() answers. @param model  driven by displacement
[[nodiscard]] SurfaceMaps surfaceMapsOf(const MetaModel& model);

}  // namespace palpate::certify
