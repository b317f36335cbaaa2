// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::faults {

/// How the library stuck_thread is told which threads of palpate-server get stuck: "tick"; "recv" for those in which DDS receives;
/// "force-out", within DDS.
/// From SIGUSR2 until SIGUSR1.
inline constexpr char kStuckVariable[] = "PALPATE_STUCK_THREAD";

}  // namespace palpate::faults
