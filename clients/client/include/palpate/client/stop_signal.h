// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::client {

/// From now on the first SIGINT or SIGTERM only raises a flag; a second one ends the process as usual.
/// Real-time: no.
void catchStopSignals();

/// Whether such a signal has come. Real-time: yes. Threads: any.
[[nodiscard]] bool stopRequested() noexcept;

}  // namespace palpate::client
