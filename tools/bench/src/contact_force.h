// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/core/meta_model.h"

namespace palpate::bench {

/// Registers contact_force/<state>: what step() does for one tool between its pose and its force (contact, coupling,
/// friction, damper, limiter; no field), over random slides on the model, one figure for each state that a contact can
/// be in. `model` must live until the benchmarks have run.
void registerContactForce(const MetaModel& model);

}  // namespace palpate::bench
