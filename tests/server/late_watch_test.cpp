// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/late_watch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <memory>

#include "palpate/rt/clock.h"
#include "palpate/rt/thread.h"
#include "palpate/server/tick.h"

namespace palpate::server {
namespace {

using rt::kMs;
constexpr std::uint64_t kTicks = 300;

// Each 20th of them computes for 8 ms.
std::int64_t compute(void* context, const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  if (cycle.index % 20 == 19)
    for (const std::int64_t end_ns = cycle.woke_ns + 8 * kMs; rt::monotonicNow() < end_ns;) {
    }
  static_cast<std::atomic<std::uint64_t>*>(context)->store(cycle.index + 1);
  return 0;
}

TEST(LateWatch, EveryLateTickGetsOneCauseAndThoseThatComputedTheirOwn) {
  const auto channels = std::make_unique<Channels>();
  std::atomic<std::uint64_t> ticks{0};
  rt::PeriodicThread thread({"test-tick", 80, rt::RealtimePolicy::kPrefer, {}}, 2 * kMs, &compute, &ticks,
                            {&Tick::onLate, channels.get()});
  LateWatch watch(*channels, thread, thread.realtime() ? 80 : 0);
  rt::Thread watching({"test-watch", 0, rt::RealtimePolicy::kOff, {}}, [&watch] { watch.run(); });
  while (ticks.load() < kTicks) rt::sleepUntil(rt::monotonicNow() + kMs);
  thread.stop();
  channels->stopping.store(true, std::memory_order_release);  // SYNC STOP
  channels->late_watch_ready.post();
  watching.join();

  EXPECT_EQ(channels->unjudged.load(), 0U);
  std::map<rt::LateCause, int> told;
  int total = 0;
  for (LateTick tick; channels->late_ticks.pop(tick); ++total) {
    ++told[tick.cause];
    EXPECT_GT(tick.late_ns, kMs) << "half a period";
    EXPECT_TRUE(tick.cause == rt::LateCause::kPreempted || tick.by[0] == '\0');
  }
  EXPECT_GE(total, static_cast<int>(kTicks / 20)) << "each that computed for 8 ms was late";
  // Other threads and the host may keep each of them longer than it computes.
  const int kept = told[rt::LateCause::kPreempted] + told[rt::LateCause::kHostSteal];
  const int least = thread.realtime() ? static_cast<int>(kTicks / 20) * 8 / 10 - kept : 1;
  EXPECT_GE(told[rt::LateCause::kOwnWork], least);
}

}  // namespace
}  // namespace palpate::server
