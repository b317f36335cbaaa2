// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace palpate::bench {

/// Keeps this thread on one processor. @param[in] cpu its number; -1: the last processor that it may use
/// @return the number. @throw std::runtime_error when it may not run there
int pinTo(int cpu);

/// Gives this thread the tick's policy and priority, SCHED_FIFO 80: other work on its processor waits.
/// @throw std::runtime_error when the system refuses
void raiseLikeTheTick();

/// Causes of disturbed measurements on that processor, one sentence each: other load, a governor other than
/// "performance". Empty: none found.
[[nodiscard]] std::vector<std::string> disturbances(int cpu);

}  // namespace palpate::bench
