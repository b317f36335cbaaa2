// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "palpate/rt/cpu_rivals.h"
#include "palpate/rt/late_judge.h"
#include "palpate/rt/periodic_thread.h"
#include "palpate/server/channels.h"

namespace palpate::server {

/// Says of every late tick why (docs/decisions/late_ticks.md): each 20 ms it looks at what the tick's thread has queued, more
/// seldom at what the host stole and at other threads, and judges ticks that were late meanwhile. It also notices when the
/// machine's wall clock is set. Threads: one, an ordinary one. Real-time: no.
class LateWatch {
 public:
  /// Both must outlive the watch. @param[in] priority  the tick's SCHED_FIFO priority; 0: none
  LateWatch(Channels& channels, const rt::PeriodicThread& tick, int priority);

  /// Body of the late-watch thread. Returns when the server stops, once all late ticks are judged.
  void run() noexcept;

 private:
  void sample(std::int64_t now_ns);
  void judge(std::int64_t now_ns, bool at_once);
  void namePreempted(std::int64_t now_ns, bool at_once);
  void tell(const rt::LateVerdict& verdict, const std::string& by);
  void look(std::int64_t now_ns);
  void lookAtWallClock();

  Channels& channels_;
  const rt::PeriodicThread& tick_;
  rt::LateJudge judge_;
  rt::RunQueueFile queue_;
  rt::CpuRivals rivals_;
  std::vector<rt::LateVerdict> unnamed_;  // preempted by a thread to be found
  std::int64_t steal_due_ns_{0};
  std::int64_t looked_ns_{0};
  std::int64_t wall_ahead_ns_{0};  // CLOCK_REALTIME - CLOCK_BOOTTIME; 0: not read yet
};

}  // namespace palpate::server
