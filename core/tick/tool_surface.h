// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/tick/surface_state.h"
#include "core/tick/workspace.h"

namespace palpate {

/// What each tool in contact adds to the surface; a tool whose force fades takes its dimple with it.   docs/design.md,
/// Parts. Real-time: yes.
void findSources(const MetaModel& model, std::span<const ToolMemory, kMaxTools> tools,
                 FieldSources& sources) noexcept PALPATE_NONBLOCKING;

/// The field at the tools' anchors, m; zero where a tool has none. Cost that of fieldAt() and addOthersAt().
/// @return false when the model overflows: u is zero there. Real-time: yes.
[[nodiscard]] bool fieldAtAnchors(const MetaModel& model, std::span<const ToolMemory, kMaxTools> tools,
                                  std::span<const FieldSource> sources, FieldScratch& scratch,
                                  Touches& touches,
                                  std::span<Vec3, kMaxTools> u) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
