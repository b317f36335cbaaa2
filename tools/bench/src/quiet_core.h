// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace palpate::bench {

/// Keeps this thread on one processor. @param[in] cpu  its number; -1: the last one of those that it may use
/// @return the number. @throw std::runtime_error when it may not run there
int pinTo(int cpu);

/// Gives this thread the tick's policy and priority, SCHED_FIFO 80: whatever else wants its processor waits.
/// @throw std::runtime_error when that is not granted
void raiseLikeTheTick();

/// What on this machine disturbs measurements on that processor, one sentence each: other load, a governor that is not
/// "performance". Empty: nothing was found.
[[nodiscard]] std::vector<std::string> disturbances(int cpu);

}  // namespace palpate::bench
