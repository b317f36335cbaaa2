// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/meta_model.h"

namespace palpate::certify {

/// How far the forces in the file are from having an energy: of all contact positions the largest |f - dW/dd| over the largest
/// |f|, both in the ball |d| <= d_max, W(d) = int_0^1 f(tau d) . d dtau. f is the sum of /contact/force, which a tick does not
/// use as it is: it derives its force from W. Looked at in 26 directions and at 4 lengths.
/// @param model  driven by displacement  @return 0 where no position has a domain
[[nodiscard]] double energyAsymmetry(const MetaModel& model);

}  // namespace palpate::certify
