// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "palpate/idl/reader.h"

namespace palpate::dds {

/// Names a participant of the domain; one that restarts gets another.
using ParticipantId = std::array<std::uint8_t, 16>;

/// Whose a writer is. Nothing when the reader does not know it, or no more. @param[in] reader  that matched the writer
/// Real-time: no, it locks and allocates.
[[nodiscard]] std::optional<ParticipantId> participantOf(dds_entity_t reader, WriterId writer);

}  // namespace palpate::dds
