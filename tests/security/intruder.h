// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate::testing {

/// Of the forces that an intruder sends: no server has it.
inline constexpr std::uint64_t kIntrudersSession = 4242;
/// What an intruder asks for.
inline constexpr double kIntrudersFriction = 0.01;

}  // namespace palpate::testing
