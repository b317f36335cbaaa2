// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/periodic_thread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <ctime>
#include <stdexcept>
#include <thread>

#include "palpate/rt/clock.h"
#include "palpate/rt/semaphore.h"

namespace palpate::rt {
namespace {

constexpr std::int64_t kTestPeriod = 1'000'000;

TEST(NextDeadline, IsOnePeriodLaterWhenTheCycleWasOnTime) {
  const Deadline next = nextDeadline(5 * kTestPeriod, kTestPeriod, 5 * kTestPeriod + kTestPeriod / 3);
  EXPECT_EQ(next.ns, 6 * kTestPeriod);
  EXPECT_EQ(next.missed, 0U);
}

TEST(NextDeadline, SkipsWhatIsPastAndKeepsThePhase) {
  const Deadline next = nextDeadline(5 * kTestPeriod, kTestPeriod, 8 * kTestPeriod + 1);
  EXPECT_EQ(next.ns, 9 * kTestPeriod);
  EXPECT_EQ(next.missed, 3U);
}

TEST(NextDeadline, IsNeverInThePast) {
  for (std::int64_t now = 0; now < 5 * kTestPeriod; now += 77'777)
    EXPECT_GT(nextDeadline(0, kTestPeriod, now).ns, now);
}

TEST(NextDeadline, AShiftMovesTheGridAndIsNeverAReasonToMissAPeriod) {
  for (const std::int64_t shift : {-10'000, 10'000}) {
    const Deadline next =
        nextDeadline(5 * kTestPeriod, kTestPeriod, 5 * kTestPeriod + kTestPeriod / 3, shift);
    EXPECT_EQ(next.ns, 6 * kTestPeriod + shift);
    EXPECT_EQ(next.missed, 0U);
  }
  const std::int64_t busy_until = 6 * kTestPeriod - 4'000;  // later than the shifted deadline
  const Deadline next = nextDeadline(5 * kTestPeriod, kTestPeriod, busy_until, -10'000);
  EXPECT_EQ(next.ns, busy_until + 1);
  EXPECT_EQ(next.missed, 0U);
  EXPECT_EQ(nextDeadline(5 * kTestPeriod, kTestPeriod, 8 * kTestPeriod + 1, 10'000).missed, 3U);
}

struct Log {
  static constexpr std::size_t kCycles = 40;
  std::array<Cycle, kCycles> cycles;
  std::size_t count{0};
  bool pause{true};
  Semaphore done;
};

// Cycle 10 blocks for 5.5 periods: the overrun that the test is about.
std::int64_t logCycle(void* context, const Cycle& cycle) noexcept {
  auto& log = *static_cast<Log*>(context);
  if (log.count == Log::kCycles) return 0;
  log.cycles[log.count] = cycle;
  if (log.count == 10 && log.pause) {
    const timespec pause = toTimespec(5 * kTestPeriod + kTestPeriod / 2);
    nanosleep(&pause, nullptr);
  }
  if (++log.count == Log::kCycles) log.done.post();
  return 0;
}

// The compiler knows that this cycle may block: the test is about what happens then.
PALPATE_TRUSTED_BEGIN
constexpr PeriodicThread::Function kLogCycle = logCycle;
PALPATE_TRUSTED_END

TEST(PeriodicThread, WhoseCycleDoesNotEndIsWaitedForOnlySoLong) {
  struct Spin {
    std::atomic<bool> began{false}, go_on{false};
  } spin;
  const auto cycle = [](void* context, const Cycle&) noexcept PALPATE_NONBLOCKING -> std::int64_t {
    auto& state = *static_cast<Spin*>(context);
    state.began = true;
    while (!state.go_on) {
    }
    return 0;
  };
  PeriodicThread thread({"test-spins"}, kTestPeriod, cycle, &spin);
  while (!spin.began) std::this_thread::yield();  // a thread told to stop before its first cycle makes none
  EXPECT_FALSE(thread.joinWithin(std::chrono::milliseconds(20)));
  spin.go_on = true;
  EXPECT_TRUE(thread.joinWithin(std::chrono::seconds(20)));
}

TEST(PeriodicThread, MissedPeriodsAreCountedAndNeverBunched) {
  Log log;
  PeriodicThread thread({"test-periodic", 0, RealtimePolicy::kOff}, kTestPeriod, kLogCycle, &log);
  log.done.wait();
  thread.stop();
  EXPECT_FALSE(thread.realtime());
  EXPECT_EQ(log.cycles[0].index, 0U);
  EXPECT_EQ(log.cycles[0].overruns, 0U);
  EXPECT_EQ(log.cycles[0].previous_ns, 0);
  for (std::size_t i = 1; i < Log::kCycles; ++i) {
    const Cycle& last = log.cycles[i - 1];
    const Cycle& cycle = log.cycles[i];
    EXPECT_EQ(cycle.index, i);
    EXPECT_GE(cycle.woke_ns, cycle.deadline_ns) << "woke before it was due";
    EXPECT_GE(cycle.deadline_ns, last.woke_ns) << "due before the last one began";
    const std::int64_t periods = (cycle.deadline_ns - last.deadline_ns) / kTestPeriod;
    EXPECT_EQ((cycle.deadline_ns - last.deadline_ns) % kTestPeriod, 0) << "left the grid";
    EXPECT_EQ(static_cast<std::int64_t>(cycle.overruns - last.overruns), periods - 1) << "miscounted";
  }
  EXPECT_GE(log.cycles[11].overruns - log.cycles[10].overruns, 5U);
  EXPECT_GE(log.cycles[11].previous_ns, 5 * kTestPeriod);
}

// Shifts the grid by 1 % of a period in each cycle: it moves by exactly that, and no period is missed.
std::int64_t shiftCycle(void* context, const Cycle& cycle) noexcept {
  (void)logCycle(context, cycle);
  return cycle.index < 20 ? 10'000 : -10'000;
}

PALPATE_TRUSTED_BEGIN
constexpr PeriodicThread::Function kShiftCycle = shiftCycle;
PALPATE_TRUSTED_END

TEST(PeriodicThread, MovesItsGridByWhatTheCycleAsksFor) {
  Log log;
  log.pause = false;
  PeriodicThread thread({"test-periodic", 0, RealtimePolicy::kOff}, kTestPeriod, kShiftCycle, &log);
  log.done.wait();
  thread.stop();
  for (std::size_t i = 1; i < Log::kCycles; ++i) {
    const Cycle &last = log.cycles[i - 1], &cycle = log.cycles[i];
    const auto periods = static_cast<std::int64_t>(1 + cycle.overruns - last.overruns);
    if (last.woke_ns + cycle.previous_ns >= cycle.deadline_ns - 1)
      continue;  // a stall ended in the last microseconds
    const std::int64_t shift = cycle.deadline_ns - last.deadline_ns - periods * kTestPeriod;
    EXPECT_EQ(shift, last.index < 20 ? 10'000 : -10'000) << i;
  }
}

struct Rehearsed {
  Log log;
  std::array<int, Log::kCycles> rehearsals{};  // before each cycle
  std::int64_t newest_ns{0};
  std::array<std::int64_t, Log::kCycles> rehearsed_ns{};
};

std::int64_t cycleOfRehearsed(void* context, const Cycle& cycle) noexcept {
  auto& rehearsed = *static_cast<Rehearsed*>(context);
  if (rehearsed.log.count < Log::kCycles) rehearsed.rehearsed_ns[rehearsed.log.count] = rehearsed.newest_ns;
  return logCycle(&rehearsed.log, cycle);
}

PALPATE_TRUSTED_BEGIN
constexpr PeriodicThread::Function kCycleOfRehearsed = cycleOfRehearsed;
PALPATE_TRUSTED_END

void rehearse(void* context) noexcept PALPATE_NONBLOCKING {
  auto& rehearsed = *static_cast<Rehearsed*>(context);
  if (rehearsed.log.count < Log::kCycles) ++rehearsed.rehearsals[rehearsed.log.count];
  rehearsed.newest_ns = monotonicNow();
}

TEST(PeriodicThread, RehearsesOnceBeforeEachDeadlineThatItWakesBefore) {
  constexpr std::int64_t kLead = kTestPeriod / 4;
  Rehearsed rehearsed;
  rehearsed.log.pause = false;
  PeriodicThread thread({"test-rehearsal", 0, RealtimePolicy::kOff}, kTestPeriod, kCycleOfRehearsed,
                        &rehearsed, {}, {rehearse, &rehearsed, kLead});
  rehearsed.log.done.wait();
  thread.stop();
  int times = 0;
  for (std::size_t i = 0; i < Log::kCycles; ++i) {
    const Cycle& cycle = rehearsed.log.cycles[i];
    EXPECT_GE(cycle.woke_ns, cycle.deadline_ns) << "the cycle before it was due: " << i;
    ASSERT_LE(rehearsed.rehearsals[i], 1);
    if (rehearsed.rehearsals[i] == 0) {
      EXPECT_TRUE(cycle.woke_ns > cycle.deadline_ns || cycle.previous_ns > kLead) << i;  // a stall
      continue;
    }
    ++times;
    EXPECT_GE(rehearsed.rehearsed_ns[i], cycle.deadline_ns - kLead) << i;
    EXPECT_LE(rehearsed.rehearsed_ns[i], cycle.woke_ns) << i;
  }
  EXPECT_GT(times, 0);
}

TEST(AwaitDeadline, ThatIsPastDoesNotRehearse) {
  Rehearsed rehearsed;
  const std::int64_t now_ns = monotonicNow();
  EXPECT_GE(awaitDeadline(now_ns, {rehearse, &rehearsed, kTestPeriod}, 0), now_ns);
  EXPECT_EQ(rehearsed.rehearsals[0], 0);
  const std::int64_t due_ns = monotonicNow() + 5 * kTestPeriod;
  EXPECT_GE(awaitDeadline(due_ns, {}, 0), due_ns);
}

TEST(AwaitDeadline, AfterALongCycleDoesNotRehearse) {
  Rehearsed rehearsed;
  constexpr std::int64_t kLead = 20 * kTestPeriod;
  const auto await = [&](std::int64_t previous_ns) {
    const std::int64_t due_ns = monotonicNow() + kLead + kTestPeriod;
    EXPECT_GE(awaitDeadline(due_ns, {rehearse, &rehearsed, kLead}, previous_ns), due_ns);
    return rehearsed.rehearsals[0];
  };
  EXPECT_EQ(await(kLead + 1), 0);
  int tries = 10;  // a machine that stalls for the lead leaves none
  while (tries-- > 0 && await(kLead) == 0) {
  }
  EXPECT_EQ(rehearsed.rehearsals[0], 1);
}

TEST(RehearsalLead, IsASmallPartOfThePeriod) {
  EXPECT_EQ(rehearsalLead(1'000'000), 50'000);
  EXPECT_EQ(rehearsalLead(250'000), 31'250);
  EXPECT_EQ(rehearsalLead(100'000), 12'500);
}

struct LateLog {
  std::array<LateCycle, 4 * Log::kCycles> cycles;
  std::size_t count{0};
};

void noteLate(void* context, const LateCycle& cycle) noexcept PALPATE_NONBLOCKING {
  auto& log = *static_cast<LateLog*>(context);
  if (log.count < log.cycles.size()) log.cycles[log.count++] = cycle;
}

TEST(PeriodicThread, TellsOfEachLateCycleWhatTheKernelSaysOfIt) {
  Log log;
  LateLog late;
  PeriodicThread thread({"test-periodic", 0, RealtimePolicy::kOff}, kTestPeriod, kLogCycle, &log,
                        {noteLate, &late});
  log.done.wait();
  thread.stop();
  EXPECT_GT(thread.id(), 0);
  const auto* const paused =
      std::find_if(late.cycles.begin(), late.cycles.begin() + late.count,
                   [&](const auto& cycle) { return cycle.deadline_ns == log.cycles[10].deadline_ns; });
  ASSERT_NE(paused, late.cycles.begin() + late.count) << "the cycle that blocked is not among the late ones";
  EXPECT_GE(paused->missed, 5U);
  EXPECT_EQ(paused->woke_ns, log.cycles[10].woke_ns);
  EXPECT_GE(paused->ended.at_ns - paused->woke_ns, 5 * kTestPeriod);
  EXPECT_LT(paused->ended.cpu_ns - paused->before.cpu_ns, 3 * kTestPeriod) << "it slept";
  EXPECT_GE(paused->ended.waits - paused->before.waits, 1);
  EXPECT_LE(paused->before.at_ns, paused->deadline_ns);
  for (std::size_t i = 0; i < late.count; ++i) {
    const LateCycle& cycle = late.cycles[i];
    EXPECT_TRUE(cycle.missed > 0 || cycle.woke_ns - cycle.deadline_ns > kTestPeriod / 2) << i;
  }
}

TEST(PeriodicThread, RefusesAPeriodOfZero) {
  try {
    PeriodicThread thread({"test-periodic", 0, RealtimePolicy::kOff}, 0, kLogCycle, nullptr);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "thread test-periodic: period is 0 ns, expected more than 0");
  }
}

}  // namespace
}  // namespace palpate::rt
