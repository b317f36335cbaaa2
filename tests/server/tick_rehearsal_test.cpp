// SPDX-License-Identifier: Apache-2.0
// What is rehearsed warms caches and is otherwise not to be seen.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "palpate/testing/allocation_guard.h"
#include "tick_fixture.h"

namespace palpate::server::testing {
namespace {

class TickRehearsal : public TickTest {
 protected:
  void step() noexcept {
    runOneTick();
    Tick::onRehearsal(&tick_);
  }

  // A press with two tools, a pause of the second, a pose that is refused; each tick followed by `between`.
  std::vector<ForceRecord> play(const std::function<void(int)>& between) {
    for (int i = 0; i < 200; ++i) {
      send(poseAtDepth(0, 0.002 * std::sin(0.03 * i)));
      if (i > 40 && i != 70 && i < 120) send(poseAtDepth(1, 1e-5 * i));
      if (i == 90) {
        dds::ToolPose pose = poseAtDepth(0, 0.001);
        pose.orientation[3] = 0.0;
        send(pose);
      }
      runOneTick();
      between(i);
    }
    return takeForces();
  }

  void expectForcesOfATickWithoutRehearsals(const std::vector<ForceRecord>& forces);
};

// Another fixture's tick, engine and channels see the same poses at the same times.
class Plain : public TickRehearsal {
 public:
  void TestBody() override {}
  std::vector<ForceRecord> forces() {
    return play([](int) {});
  }
};

void TickRehearsal::expectForcesOfATickWithoutRehearsals(const std::vector<ForceRecord>& forces) {
  const std::vector<ForceRecord> plain = Plain().forces();
  ASSERT_EQ(forces.size(), plain.size());
  bool pressed = false;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_EQ(forces[i].result.force, plain[i].result.force) << i;
    EXPECT_EQ(forces[i].result.stiffness, plain[i].result.stiffness) << i;
    EXPECT_EQ(forces[i].result.flags, plain[i].result.flags) << i;
    pressed = pressed || plain[i].result.force != std::array<double, 3>{};
  }
  EXPECT_TRUE(pressed);
}

TEST_F(TickRehearsal, FollowsATickBehindAndChangesNoForce) {
  expectForcesOfATickWithoutRehearsals(play([&](int i) {
    Tick::onRehearsal(&tick_);
    EXPECT_TRUE(engine_.rehearsal.surface() == work_.surface()) << i;
  }));
}

TEST_F(TickRehearsal, ThatIsLeftOutOrDoneTwiceChangesNoForce) {
  expectForcesOfATickWithoutRehearsals(play([&](int i) {
    for (int turn = 0; turn < i % 3; ++turn) Tick::onRehearsal(&tick_);
  }));
}

TEST_F(TickRehearsal, TakesSettingsThatCameWhileItWasLeftOut) {
  send(poseAtDepth(0, 0.001));
  step();
  AllToolSettings settings = toolSettings(StepConfig{});
  settings[0].live.friction = 0.7;
  channels_->parameters.write(settings);
  runOneTick();  // not rehearsed
  for (int i = 0; i < 300; ++i) step();
  EXPECT_NEAR(work_.live().friction, 0.7, 1e-9);
  EXPECT_EQ(engine_.rehearsal.live().friction, work_.live().friction);
}

TEST_F(TickRehearsal, BeforeTheFirstTickDoesNothing) {
  Tick::onRehearsal(&tick_);
  send(poseAtDepth(0, 0.001));
  step();
  EXPECT_EQ(takeForces().size(), 1U);
}

TEST_F(TickRehearsal, AllocatesNothing) {
  send(poseAtDepth(0, -0.001));
  step();
  const palpate::testing::AllocationGuard guard;
  for (int i = 0; i < 50; ++i) {
    send(poseAtDepth(0, 4e-5 * i));
    step();
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::server::testing
