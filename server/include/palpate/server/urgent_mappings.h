// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace palpate::server {

/// Set once forces have a real-time priority: from then on a thread of palpate-server has one, too, while it maps memory
/// (server/src/urgent_mappings.cpp). Relaxed: nothing is published by it.
inline std::atomic<bool> urgent_mappings{false};
inline constexpr int kMappingPriority = 1;  ///< SCHED_FIFO, the lowest

}  // namespace palpate::server
