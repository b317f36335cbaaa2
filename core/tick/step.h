// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/status_flags.h"
#include "core/model/meta_model.h"
#include "core/tick/step_io.h"
#include "core/tick/workspace.h"

namespace palpate {

/// One tick: poses in, forces and the surface's displacement out (docs/design.md, Contact, Safety): stepForces(), then stepSurface()
/// unless it is skipped. Bad input never stops it and never comes out: each has a defined, safe, continuous answer and a
/// flag; kNonFiniteForce of a surface that overflows where no tool is comes with the next tick. Allocates nothing, takes
/// no lock, throws nothing. Real-time: yes. Threads: one per Workspace.
[[nodiscard]] StepStatus step(const MetaModel& model, Workspace& work, const StepInput& input,
                              StepResult& result) noexcept PALPATE_NONBLOCKING;

/// A tick without the surface, so that forces do not wait for the picture. Cost O(C n + tools^2 (C + K_m)), whatever the
/// number of nodes. Real-time: yes.
[[nodiscard]] StepStatus stepForces(const MetaModel& model, Workspace& work, const StepInput& input,
                                    StepResult& result) noexcept PALPATE_NONBLOCKING;

/// The surface under what the last stepForces() found, into Workspace::displacement(). At most once after each of them.
/// @return false when nothing moved: it is the surface of before. Cost O(n Ns), nothing when nothing moved. Real-time: yes.
bool stepSurface(const MetaModel& model, Workspace& work) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
