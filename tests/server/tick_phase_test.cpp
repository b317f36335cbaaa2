// SPDX-License-Identifier: Apache-2.0
// Whose poses the ticks follow. The test keeps the time.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <optional>

#include "tick_fixture.h"

namespace palpate::server::testing {
namespace {

// Tools that send by a clock of their own.
class TickPhaseTest : public TickTest {
 protected:
  struct Sender {
    std::int64_t period_ns{0};  // 0: it does not send
    std::int64_t next_ns{0};
    std::optional<std::int64_t> lead_ns;  // it sends in answer to our ticks, so long before the next
    bool good{true};
  };

  // At `at_ns` of each period from now on.
  void begin(std::size_t tool, std::int64_t at_ns, std::int64_t period_ns = kPeriod) {
    senders_[tool] = {period_ns, now_ns_ / period_ns * period_ns + period_ns + at_ns, std::nullopt, true};
  }
  void answerTicks(std::size_t tool, std::int64_t lead_ns) { senders_[tool].lead_ns = lead_ns; }
  void end(std::size_t tool) { senders_[tool] = {}; }

  TickRecord run(int ticks) {
    travelled_ = 0;
    for (int i = 0; i < ticks; ++i) {
      for (std::size_t tool = 0; tool < senders_.size(); ++tool) sendAllOf(tool);
      cycle_.deadline_ns = cycle_.woke_ns = now_ns_;
      const std::int64_t shift = locking_.run(cycle_);
      travelled_ += std::abs(shift);
      now_ns_ += kPeriod + shift;
      ++cycle_.index;
      (void)takeForces();
    }
    return takeLastRecord();
  }

  [[nodiscard]] double lead(std::int64_t at_ns) const {
    return static_cast<double>(now_ns_ % kPeriod - at_ns);
  }

  std::array<Sender, 2> senders_;
  Tick locking_{engine_, *channels_, {kPeriod, 0, true}};
  std::int64_t travelled_{0};  // by the grid, in the last run()

 private:
  void sendAllOf(std::size_t tool) {
    Sender& sender = senders_[tool];
    if (sender.lead_ns) accept(tool, now_ns_ - *sender.lead_ns);
    for (; sender.period_ns > 0 && sender.next_ns <= now_ns_; sender.next_ns += sender.period_ns)
      accept(tool, sender.next_ns);
  }
  void accept(std::size_t tool, std::int64_t at_ns) {
    dds::ToolPose pose = poseAtDepth(static_cast<std::uint32_t>(tool), -0.01);
    if (!senders_[tool].good) pose.position[0] = std::numeric_limits<double>::quiet_NaN();
    intake_.accept(pose, kSender, at_ns);
  }
};

constexpr auto kLocked = static_cast<std::uint32_t>(rt::PhaseState::kLocked);
constexpr auto kFree = static_cast<std::uint32_t>(rt::PhaseState::kFree);
constexpr auto kWaiting = static_cast<std::uint32_t>(rt::PhaseState::kWaiting);

TEST_F(TickPhaseTest, TheTicksFollowThePosesOfTheToolThatHadAPhaseFirst) {
  begin(0, 300'000);
  begin(1, 800'000);
  EXPECT_EQ(run(300).phase, kLocked);
  EXPECT_NEAR(lead(300'000), 80e3, 60e3) << "after the first tool's poses";
  end(0);
  EXPECT_EQ(run(300).phase, kLocked);
  EXPECT_NEAR(lead(800'000), 80e3, 60e3) << "after the second's, now that the first is gone";
  begin(0, 300'000);
  EXPECT_EQ(run(300).phase, kLocked);
  EXPECT_NEAR(lead(800'000), 80e3, 60e3) << "and so it stays";
  end(0);
  end(1);
  EXPECT_EQ(run(300).phase, kFree);
}

TEST_F(TickPhaseTest, AToolWithoutAPhaseKeepsNoOtherFromBeingFollowed) {
  begin(0, 0, 33'333'333);  // 30 Hz: each pose comes a third of a period from the last
  EXPECT_EQ(run(2000).phase, kFree);
  begin(1, 600'000);
  EXPECT_EQ(run(200).phase, kLocked);
  EXPECT_NEAR(lead(600'000), 80e3, 60e3);
  EXPECT_EQ(run(5000).phase, kLocked);
  EXPECT_NEAR(lead(600'000), 80e3, 60e3);
}

TEST_F(TickPhaseTest, PosesThatTheEngineRejectsAreNotFollowed) {
  begin(0, 300'000);
  senders_[0].good = false;
  EXPECT_EQ(run(300).phase, kFree);
  EXPECT_EQ(travelled_, 0);
  begin(1, 700'000);
  EXPECT_EQ(run(300).phase, kLocked);
  EXPECT_NEAR(lead(700'000), 80e3, 60e3);
}

TEST_F(TickPhaseTest, AToolWaitsForNothingThatAnotherEarned) {
  answerTicks(0, 500'000);  // it moves as we do: no shift brings it nearer
  EXPECT_EQ(run(30'000).phase, kWaiting);
  begin(1, 700'000);
  EXPECT_EQ(run(200).phase, kLocked);
  EXPECT_NEAR(lead(700'000), 80e3, 60e3);
}

// Two tools in turn, neither of which can be followed: each has its own wait, whatever the other does between.
TEST_F(TickPhaseTest, TakingTurnsDoesNotShortenAWait) {
  std::int64_t early = 0, late = 0;
  for (int turn = 0; turn < 60; ++turn) {
    const auto tool = static_cast<std::size_t>(turn % 2);
    answerTicks(tool, 500'000);
    (void)run(1000);
    end(tool);
    (turn < 10 ? early : late) += travelled_;
  }
  EXPECT_GT(early, kPeriod) << "the grid never went after them: nothing was tried";
  EXPECT_LT(late, 10 * kPeriod) << "a try in each turn would be half a period in each of 50";
}

TEST_F(TickTest, WithoutPhaseLockTheTicksStayWhereTheyAre) {
  for (int i = 0; i < 300; ++i) {
    send(poseAtDepth(0, -0.01));
    runOneTick();
    ASSERT_EQ(shift_ns_, 0);
  }
  EXPECT_EQ(takeLastRecord().phase, 0U);
}

}  // namespace
}  // namespace palpate::server::testing
