// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "core/base/contact_point.h"
#include "core/model/meta_model.h"

namespace palpate::feel {

/// A node that palpate-device can be told with --at.
struct PressPlace {
  std::string_view name;  ///< highest, softest, median or stiffest
  ContactPoint s;
};

/// Where a device is tried: the highest node, on which palpate-device presses by default, and those of the least, the median and the
/// largest normal stiffness at rest. Of the accessible nodes whose neighbours are accessible too; where there are none, of all that are
/// accessible. Each node once.
[[nodiscard]] std::vector<PressPlace> pressPlaces(const MetaModel& model);

}  // namespace palpate::feel
