// SPDX-License-Identifier: Apache-2.0
// When a tick that is told to stop says that all forces are zero (docs/decisions/shutdown.md).
#include <array>

#include "tick_fixture.h"

namespace palpate::server {
namespace {

class TickStop : public testing::TickTest {
 protected:
  // A tool that presses.
  void press(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      send(poseAtDepth(0, 0.001));
      runOneTick();
    }
  }
};

TEST_F(TickStop, TellsWhenZeroForceIsInTheRing) {
  for (int i = 0; i < 100; ++i) {
    send(poseAtDepth(0, 0.001));
    runOneTick();
  }
  (void)takeForces();
  channels_->shutting_down = true;
  int ticks = 0;
  while (!channels_->zero_force_made.load() && ticks < 1000) {
    send(poseAtDepth(0, 0.001));
    runOneTick();
    ++ticks;
  }
  EXPECT_LE(ticks, 50) << "30 ms of ramp and ten ticks of zero";
  const auto forces = takeForces();
  ASSERT_GE(forces.size(), 10U);
  for (auto last = forces.end() - 10; last != forces.end(); ++last) {
    EXPECT_EQ(last->result.force, (std::array<double, 3>{}));
    EXPECT_NE(last->result.flags & kShuttingDown, 0U);
  }
}

// A force-out that hangs: what found no room in its ring was sent to nobody.
TEST_F(TickStop, ZeroForceThatFoundNoRoomDoesNotCount) {
  press(2100);
  channels_->shutting_down = true;
  press(100);
  EXPECT_FALSE(channels_->zero_force_made.load());
  (void)takeForces();
  press(10);
  EXPECT_TRUE(channels_->zero_force_made.load());
}

// Events that hang: their ring is full, that of the forces is not.
TEST_F(TickStop, ZeroForceCountsWhereNobodyTakesReports) {
  for (int i = 0; i < 50; ++i, (void)takeForces()) press(100);
  channels_->shutting_down = true;
  press(50);
  EXPECT_TRUE(channels_->zero_force_made.load());
  (void)takeLastRecord();
  press(1);
  EXPECT_GT(takeLastRecord().dropped, 0U) << "the reports' ring was full";
}

}  // namespace
}  // namespace palpate::server
