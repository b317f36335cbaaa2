// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/status_flags.h"
#include "core/model/meta_model.h"
#include "core/tick/step_io.h"
#include "core/tick/workspace.h"

namespace palpate {

/// One tick: poses in, forces out, and what the surface is made of (docs/design.md, Contact, Safety): Workspace::surface().
/// Bad input never stops it and never comes out: each has a defined, safe, continuous answer and a flag. Allocates nothing,
/// takes no lock, throws nothing. Cost O(C n + tools^2 (C + K_m)), whatever the number of nodes. Real-time: yes. Threads:
/// one per Workspace.
[[nodiscard]] StepStatus step(const MetaModel& model, Workspace& work, const StepInput& input,
                              StepResult& result) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
