// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/meta_model.h"

namespace palpate::bench {

/// Registers contact_force/<state>: the part of step() from one tool's pose to its force (contact, coupling,
/// friction, damper, limiter; no field), over random slides on the model, one time for each state of a
/// contact. `model` must live until the benchmarks have run.
void registerContactForce(const MetaModel& model);

}  // namespace palpate::bench
