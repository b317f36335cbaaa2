// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

#include "palpate/rt/process_threads.h"

namespace palpate::rt {

/// Bounds how long a thread of this process may compute at real-time priority without a sleep (RLIMIT_RTTIME). The
/// kernel counts in ticks of 1 to 10 ms. Beyond `longest` it sends SIGXCPU to the process, and again each second, but
/// does not say for which thread: spinningThreads() finds it. Beyond `last` it kills the process, so that a machine stays
/// usable even where nothing else of the process gets a processor.
/// @param[in] longest  more than 0; a call that lowers it again holds from then on
/// @param[in] last     at least `longest`
/// @return 0, or the errno of the refusal. Real-time: no.
[[nodiscard]] int limitRealtimeWithoutSleep(std::chrono::milliseconds longest,
                                            std::chrono::milliseconds last) noexcept;

/// Threads at real-time priority that neither slept nor waited during `time`, and computed for most of it.
/// Real-time: no; takes `time`.
[[nodiscard]] std::vector<ThreadFacts> spinningThreads(std::chrono::milliseconds time);

/// Makes a thread an ordinary one for good: "-low" behind its name keeps raiseThreadsNamed() off it. Raised again it would
/// go on to be counted where it was, up to `last`.
/// @return 0, or the errno of the refusal. Real-time: no.
[[nodiscard]] int lowerThread(const ThreadFacts& thread);

}  // namespace palpate::rt
