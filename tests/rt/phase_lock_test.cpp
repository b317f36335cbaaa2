// SPDX-License-Identifier: Apache-2.0
// A sender, its wire and our ticks, all in the test's own time.
#include "palpate/rt/phase_lock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

#include "palpate/rt/periodic_thread.h"

namespace palpate::rt {
namespace {

constexpr std::int64_t kPeriod = 1'000'000;
constexpr std::int64_t kSlew = 10'000;  // 1 % of it

class World {
 public:
  // Lateness of a value's arrival, ns.
  using Delay = std::function<double()>;

  explicit World(std::int64_t period_ns = kPeriod) : period_(period_ns), lock_(period_ns) {}

  std::int64_t period_;
  double sender_period = static_cast<double>(period_);
  double next_send = 5e9;  // what is sent from here on
  bool sending = true;
  Delay delay = [] { return 0.0; };

  // One tick: the values before it, and the next deadline.
  void tick() {
    while (next_send < static_cast<double>(deadline_ + period_)) {  // all that may arrive before this tick
      if (sending) underway_.push_back(static_cast<std::int64_t>(next_send + delay()));
      next_send += sender_period;
    }
    Arrivals arrivals;
    const auto came = std::partition(underway_.begin(), underway_.end(),
                                     [&](std::int64_t arrival) { return arrival > deadline_; });
    for (auto it = came; it != underway_.end(); ++it)
      arrivals = {arrivals.count + 1, std::max(arrivals.newest_ns, *it)};
    underway_.erase(came, underway_.end());
    if (arrivals.count > 0) waits_.push_back(static_cast<double>(deadline_ - arrivals.newest_ns));
    ticks_without_ += arrivals.count == 0 ? 1 : 0;
    const std::int64_t shift = lock_.follow(deadline_, arrivals);
    largest_shift_ = std::max(largest_shift_, std::abs(shift));
    deadline_ += period_ + shift;
    travelled_ += std::abs(shift);
  }
  void run(int ticks) {
    waits_.clear();
    ticks_without_ = 0;
    for (int i = 0; i < ticks; ++i) tick();
  }

  [[nodiscard]] double quantile(double fraction) {
    std::sort(waits_.begin(), waits_.end());
    return waits_.at(static_cast<std::size_t>(fraction * static_cast<double>(waits_.size() - 1)));
  }

  PhaseLock lock_;
  std::int64_t deadline_ = 5'000'000'000;
  std::int64_t largest_shift_ = 0;
  std::int64_t travelled_ = 0;
  int ticks_without_ = 0;

 private:
  std::vector<std::int64_t> underway_;
  std::vector<double> waits_;
};

World::Delay gauss(double sigma_ns, unsigned seed = 3) {
  return [random = std::mt19937(seed), normal = std::normal_distribution(0.0, sigma_ns)]() mutable {
    return normal(random);
  };
}

TEST(PhaseLock, LocksFromAnyPhaseWithinAHundredTicksAndStays) {
  for (double phase = 0.0; phase < 1e6; phase += 37e3) {
    World world;
    world.next_send += phase;
    world.delay = gauss(5e3);
    world.run(100);
    ASSERT_EQ(world.lock_.state(), PhaseState::kLocked) << phase;
    world.run(2000);
    EXPECT_EQ(world.lock_.state(), PhaseState::kLocked);
    EXPECT_EQ(world.ticks_without_, 0) << "a value that missed its tick, at phase " << phase;
    EXPECT_LE(world.quantile(0.5), 150e3);
    EXPECT_GE(world.quantile(0.0), 5e3) << "the guard is eaten";
    EXPECT_LE(world.largest_shift_, kSlew);
  }
}

// The same for a stream that restarts at another phase: what was learnt of the old phase does not count for the new one.
TEST(PhaseLock, MovesNothingBeforeSixteenValuesCame) {
  World world;
  for (const double phase : {300e3, 600e3}) {
    world.next_send += phase;
    world.sending = true;
    const std::int64_t travelled = world.travelled_;
    world.run(15);
    EXPECT_EQ(world.travelled_, travelled);
    EXPECT_EQ(world.lock_.state(), PhaseState::kFree);
    world.run(3);
    EXPECT_GT(world.travelled_, travelled);
    EXPECT_EQ(world.lock_.state(), PhaseState::kSeeking);
    world.run(300);
    EXPECT_EQ(world.lock_.state(), PhaseState::kLocked);
    world.sending = false;
    world.run(60);
  }
}

// Other locks move the grid: this lock still learns its phase, and is right at once when its turn comes.
TEST(PhaseLock, LearnsThePhaseAlsoWhenItIsNotTheOneThatMovesTheGrid) {
  PhaseLock lock(kPeriod);
  std::int64_t deadline = 5'000'000'000, lead = 0;
  for (int i = 0; i < 500; ++i) {
    lead = (deadline - 300'000) % kPeriod;
    const std::int64_t shift = lock.follow(deadline, {1, deadline - lead});
    if (i > 20) {
      ASSERT_EQ(shift > 0, lead < lock.margin() || lead > lock.margin() + kPeriod / 2) << lead;
    }
    deadline += kPeriod + (i < 400 ? 3'000 : -9'000);
  }
  EXPECT_TRUE(lock.hasPhase());
}

TEST(PhaseLock, TheMarginFollowsTheJitter) {
  std::vector<double> margins;
  for (const double sigma : {2e3, 15e3, 40e3}) {
    World world;
    world.next_send += 400e3;
    world.delay = gauss(sigma);
    world.run(20'000);
    world.run(20'000);
    EXPECT_EQ(world.lock_.state(), PhaseState::kLocked);
    const double missed = world.ticks_without_ / 20'000.0;
    EXPECT_LT(missed, 0.02) << sigma;
    margins.push_back(static_cast<double>(world.lock_.margin()));
    EXPECT_NEAR(world.quantile(0.5), margins.back(), 5e3 + 0.2 * sigma);
    // A normal distribution's 98 % lies 2.05 sigma above its mean, and the guard on top.
    EXPECT_NEAR(margins.back(), 20e3 + 2.05 * sigma, 3e3 + 0.4 * sigma);
  }
  EXPECT_LT(margins[0], margins[1]);
  EXPECT_LT(margins[1], margins[2]);
}

// The next value replaces one that misses its tick, so its lateness is never seen; the lock counts it as missing.
TEST(PhaseLock, TheMarginGrowsByValuesThatNoTickEverSaw) {
  std::mt19937 random(9);
  World world;
  world.run(10'000);
  EXPECT_LT(world.lock_.margin(), 30'000);
  world.delay = [&] { return random() % 100 < 5 ? 100e3 : 0.0; };
  world.run(10'000);
  world.run(10'000);
  EXPECT_GT(world.lock_.margin(), 100'000);
  EXPECT_LT(world.ticks_without_, 100) << "of 500 that come late";
}

TEST(PhaseLock, TheMarginHasABoundWhateverTheJitter) {
  std::mt19937 random(9);
  World world;
  world.delay = [&] { return random() % 100 < 8 ? 480e3 : 0.0; };
  world.run(20'000);
  EXPECT_EQ(world.lock_.state(), PhaseState::kLocked);
  EXPECT_LE(world.lock_.margin(), 145'000);
}

TEST(PhaseLock, FollowsASenderWhoseClockIsOff) {
  for (const double ppm : {-100.0, 100.0, 800.0}) {
    World world;
    world.sender_period *= 1.0 + 1e-6 * ppm;
    world.delay = gauss(10e3);
    world.run(5000);
    world.run(20'000);  // 2 ms of drift at 100 ppm: two whole periods
    EXPECT_EQ(world.lock_.state(), PhaseState::kLocked) << ppm;
    EXPECT_NEAR(world.quantile(0.5), static_cast<double>(world.lock_.margin()), 6e3) << ppm;
    EXPECT_LT(world.ticks_without_, 100) << ppm;
    EXPECT_LE(world.largest_shift_, kSlew);
  }
}

TEST(PhaseLock, ASenderAtHalfOrTwiceTheRateIsFollowedToo) {
  for (const double rate : {0.1, 0.5, 2.0, 4.0}) {
    World world;
    world.sender_period /= rate;
    world.next_send += 600e3;
    world.delay = gauss(5e3);
    world.run(3000);
    EXPECT_EQ(world.lock_.state(), PhaseState::kLocked) << rate;
    world.run(1000);
    EXPECT_LE(world.quantile(0.5), 150e3) << rate;
  }
}

TEST(PhaseLock, KeepsThePhaseWhenTheStreamStops) {
  World world;
  world.delay = gauss(10e3);
  world.run(3000);
  ASSERT_EQ(world.lock_.state(), PhaseState::kLocked);
  world.sending = false;
  world.run(60);
  EXPECT_EQ(world.lock_.state(), PhaseState::kFree);
  const std::int64_t travelled = world.travelled_;
  world.run(1000);
  EXPECT_EQ(world.travelled_, travelled) << "the grid moved without a stream";
  world.sending = true;
  world.run(40);
  EXPECT_EQ(world.lock_.state(), PhaseState::kLocked) << "it is where it was";
}

TEST(PhaseLock, AStreamWithoutAPhaseIsNotFollowed) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(0.0, 1e6);
  World world;
  world.delay = [&] { return anywhere(random); };
  world.run(20'000);
  EXPECT_NE(world.lock_.state(), PhaseState::kLocked);
  EXPECT_LT(static_cast<double>(world.travelled_), 0.01 * 20'000 * kSlew);
}

TEST(PhaseLock, ASenderAtAnotherRateIsLeftAlone) {
  for (const double hz : {990.0, 995.0, 1005.0, 900.0, 730.0, 30.0}) {
    World world;
    world.sender_period = 1e9 / hz;
    world.delay = gauss(5e3);
    world.run(20'000);
    const std::int64_t travelled = world.travelled_;
    world.run(20'000);
    EXPECT_NE(world.lock_.state(), PhaseState::kLocked) << hz;
    EXPECT_LE(static_cast<double>(world.travelled_ - travelled), 0.02 * 20'000 * kSlew) << hz;
  }
}

// Values sent in answer to a tick come at the same phase wherever the grid goes.
TEST(PhaseLock, AStreamThatFollowsUsIsNotChased) {
  for (const std::int64_t lead : {100'000, 300'000, 700'000, 930'000}) {
    PhaseLock lock(kPeriod);
    std::int64_t deadline = 5'000'000'000, travelled = 0, last = 0;
    for (int i = 0; i < 60'000; ++i) {
      const std::int64_t shift = lock.follow(deadline, {1, deadline - lead});
      ASSERT_LE(std::abs(shift), kSlew);
      travelled += std::abs(shift);
      deadline += kPeriod + shift;
      last = i < 30'000 ? travelled : last;
    }
    EXPECT_LT(static_cast<double>(travelled - last), 0.001 * 30'000 * kPeriod)
        << lead << ": 0.1 % in the mean";
  }
}

// The sender sees the grid and tries to make it run away.
TEST(PhaseLock, AHostileStreamCannotDriveTheGridBeyondTheBound) {
  std::mt19937 random(11);
  PhaseLock lock(kPeriod);
  std::int64_t deadline = 5'000'000'000;
  const std::int64_t start = deadline;
  for (int i = 0; i < 100'000; ++i) {
    Arrivals arrivals{random() % 4, deadline - static_cast<std::int64_t>(random() % 2'000'000)};
    if (i % 3000 > 300) arrivals = {1, deadline - 600'000 + (i % 2000) * 7};
    if (i % 5000 == 0) arrivals.newest_ns = (i % 10'000 == 0) ? 0 : INT64_MAX / 4;
    const std::int64_t shift = lock.follow(deadline, arrivals);
    ASSERT_LE(std::abs(shift), kSlew);
    deadline += kPeriod + shift;
  }
  EXPECT_NEAR(static_cast<double>(deadline - start), 1e11, 1e9) << "1 % in the mean";
}

TEST(PhaseLock, AStallOfOurOwnDoesNotLoseTheLock) {
  World world;
  world.delay = gauss(10e3);
  world.run(3000);
  world.deadline_ += 17 * kPeriod;  // a host that stalls: the grid goes on where it would have been
  world.run(200);
  EXPECT_EQ(world.lock_.state(), PhaseState::kLocked);
  EXPECT_LE(world.quantile(0.5), 150e3);
}

TEST(PhaseLock, HoldsAtOtherRates) {
  for (const std::int64_t period : {100'000, 2'000'000, 10'000'000}) {
    World world(period);
    world.next_send += 0.4 * static_cast<double>(period);
    world.delay = gauss(3e3);
    world.run(20'000);
    world.run(1000);
    EXPECT_EQ(world.lock_.state(), PhaseState::kLocked) << period;
    EXPECT_NEAR(world.quantile(0.5), static_cast<double>(world.lock_.margin()), 3e3) << period;
    EXPECT_LT(world.quantile(0.5), 0.3 * static_cast<double>(period)) << period;
    EXPECT_LE(world.largest_shift_, period / 100);
  }
}

}  // namespace
}  // namespace palpate::rt
