// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

// kInContact, kStalePose and the rest: bits of ToolResult::flags, and of ToolForce::flags on the wire. Made from
// palpate.idl, the only list of the flags.
#include "palpate/core/status_flag_list.h"

namespace palpate {

/// What a tool does to the organ; ToolResult::state and ToolForce::state.
enum class ContactState : std::uint32_t { kFree = 0, kStick = 1, kSlide = 2 };

}  // namespace palpate
