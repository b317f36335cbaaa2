// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::client {

/// From now on SIGINT and SIGTERM only raise a flag; a second one ends the process the usual way.
/// Real-time: no.
void catchStopSignals();

/// Whether one has come. Real-time: yes. Threads: any.
[[nodiscard]] bool stopRequested() noexcept;

}  // namespace palpate::client
