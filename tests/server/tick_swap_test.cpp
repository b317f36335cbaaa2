// SPDX-License-Identifier: Apache-2.0
// Another engine is taken while tools press. The test keeps the time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palpate/testing/allocation_guard.h"
#include "tick_fixture.h"

namespace palpate::server::testing {
namespace {

constexpr double kRate = 10.0;  // N/s: slower than the ramp

double sizeOf(const std::array<double, 3>& force) {
  return std::hypot(force[0], force[1], force[2]);
}

StepConfig limited() {
  StepConfig config;
  config.force_rate_limit = kRate;
  return config;
}

/// Twice as stiff as the first: its forces tell which one answers.
const MetaModel& otherModel() {
  static const MetaModel model = [] {
    const palpate::testing::TemporaryFile file("other.h5");
    palpate::testing::writeSyntheticModel(file.path(), {.stiffness = 600.0});
    return MetaModel::load(file.path());
  }();
  return model;
}

class TickSwap : public TickTest {
 protected:
  // The tool at 1.5 mm; every force that was sent.
  void press(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      send(poseAtDepth(0, kDepth));
      runOneTick();
      ForceRecord record;
      while (channels_->forces.pop(record)) forces_.push_back(record);
    }
  }
  // Tool 0 of one sender, and tool 1 at 3 mm, which may pause.
  void pressWithTwo(dds::WriterId sender, bool second = true) {
    dds::ToolPose pose = poseAtDepth(0, kDepth);
    // At once into another hand: the first sender is gone.
    if (sender != kSender) intake_.left(kSender);
    intake_.accept(pose, sender, now_ns_);
    if (second) intake_.accept(poseAtDepth(1, 2.0 * kDepth), kThird, now_ns_);
    runOneTick();
  }
  void runOneTick() noexcept {
    now_ns_ += kPeriod;
    cycle_.deadline_ns = cycle_.woke_ns = now_ns_;
    (void)swapping_.run(cycle_);
    ++cycle_.index;
  }
  void offer() { channels_->next_engine.store(&other_, std::memory_order_release); }

  [[nodiscard]] bool taken() const { return channels_->engine_in_use.load() == other_.number; }

  static constexpr double kDepth = 0.0015;
  static constexpr dds::WriterId kThird = 3;
  Engine first_{{std::shared_ptr<const void>{}, &model_}, limited()};
  Engine other_{{std::shared_ptr<const void>{}, &otherModel()}, limited(), 1};
  std::vector<ForceRecord> forces_;

  Tick swapping_{first_, *channels_, {kPeriod}};
};

TEST_F(TickSwap, ForcesGoToZeroAndComeBackWithinTheRateLimitAndNoPoseIsUnanswered) {
  press(300);
  const double before = sizeOf(forces_.back().result.force);
  ASSERT_GT(before, 0.2);
  const std::size_t offered = forces_.size();
  offer();
  press(400);
  ASSERT_TRUE(taken());
  const double after = sizeOf(forces_.back().result.force);
  EXPECT_NEAR(after, 2.0 * before, 0.1 * before) << "the other organ is twice as stiff";
  ASSERT_EQ(forces_.size(), 700U);
  double steepest = 0.0;
  std::size_t at_zero = 0;
  for (std::size_t i = 1; i < forces_.size(); ++i) {
    EXPECT_EQ(forces_[i].seq, forces_[i - 1].seq + 1);
    EXPECT_EQ(forces_[i].pose_seq, forces_[i - 1].pose_seq + 1);
    std::array<double, 3> change{};
    for (std::size_t k = 0; k < 3; ++k)
      change[k] = forces_[i].result.force[k] - forces_[i - 1].result.force[k];
    steepest = std::max(steepest, sizeOf(change));
    const bool other = forces_[i].model_hash == other_.hash;
    const bool zero = sizeOf(forces_[i].result.force) == 0.0;
    if (other && forces_[i - 1].model_hash != other_.hash) at_zero = i;
    if (!other && i > offered) {
      EXPECT_NE(forces_[i].result.flags & kModelChanging, 0U) << i;
    }
    EXPECT_EQ(forces_[i].result.flags & kShuttingDown, 0U);
    if (at_zero == 0 && i > offered && zero) {
      EXPECT_EQ(forces_[i].model_hash, first_.hash);
    }
  }
  EXPECT_LE(steepest, kRate * 1e-3 * 1.000001);
  ASSERT_GT(at_zero, offered);
  EXPECT_EQ(sizeOf(forces_[at_zero - 1].result.force), 0.0) << "it was taken at zero force";
  EXPECT_NEAR(static_cast<double>(at_zero - offered), before / (kRate * 1e-3), 3.0);
}

TEST_F(TickSwap, PosesThatPauseOrChangeHandsMeanwhileRaiseNoForce) {
  for (int i = 0; i < 300; ++i) pressWithTwo(kSender);
  (void)takeForces();
  offer();
  std::array<double, kMaxTools> last{10.0, 10.0, 10.0, 10.0};
  double before_pause = 0.0, after_pause = 0.0;
  int ticks = 0;
  for (; !taken() && ticks < 1000; ++ticks) {
    // Tool 0 goes into another hand in the 10th tick, tool 1 pauses from the 20th on.
    const bool pauses = ticks >= 20 && ticks < 55;
    pressWithTwo(ticks < 10 ? kSender : kOther, !pauses);
    for (const ForceRecord& record : takeForces()) {
      if (record.model_hash != first_.hash) continue;
      const double size = sizeOf(record.result.force);
      ASSERT_LE(size, last[record.tool_id]) << "tool " << record.tool_id << ", tick " << ticks;
      last[record.tool_id] = size;
      if (ticks == 20 && record.tool_id == 1) before_pause = size;
      if (ticks == 54 && record.tool_id == 1) after_pause = size;
    }
    if (ticks == 10) {
      EXPECT_EQ(last[0], 0.0) << "a tool that changes hands";
      EXPECT_GT(last[1], 0.1) << "the other one keeps the engine from being taken";
    }
  }
  EXPECT_TRUE(taken());
  EXPECT_LT(after_pause, before_pause - 1.2 * 35 * kRate * 1e-3) << "the pause was felt";
}

TEST_F(TickSwap, IsAtOnceWhereNobodyTouches) {
  for (int i = 0; i < 5; ++i) runOneTick();
  offer();
  runOneTick();
  EXPECT_FALSE(taken()) << "settings of before may be on their way to the first";
  runOneTick();
  EXPECT_TRUE(taken());
}

TEST_F(TickSwap, NeverHappensOnceTheServerStops) {
  press(300);
  offer();
  press(3);
  channels_->shutting_down = true;
  press(400);
  EXPECT_FALSE(taken());
  EXPECT_NE(forces_.back().result.flags & kShuttingDown, 0U);
  EXPECT_EQ(forces_.back().result.flags & kModelChanging, 0U);
  EXPECT_TRUE(channels_->zero_force_made.load());
}

TEST_F(TickSwap, SettingsWrittenBeforeTheOfferGoToTheEngineBefore) {
  press(300);
  AllToolSettings settings = toolSettings(limited());
  for (ToolSettings& tool : settings) tool.live.friction = 0.01;
  channels_->parameters.write(settings);
  offer();
  press(300);
  ASSERT_TRUE(taken());
  EXPECT_LT(first_.work.live().friction, limited().friction);
  EXPECT_EQ(other_.work.live().friction, limited().friction) << "it began with what it was made with";
}

TEST_F(TickSwap, FieldsAndRecordedTicksSayWhoseTheyAre) {
  channels_->recording = std::make_unique<rt::SpscQueue<SessionTick, 16384>>();
  press(300);
  offer();
  std::uint64_t fields = 0;
  for (int i = 0; i < 300; ++i) {
    press(1);
    if (!channels_->surface.update()) continue;
    const SurfaceSample& sample = channels_->surface.front();
    EXPECT_EQ(sample.engine, taken() ? &other_ : &first_);
    fields += sample.engine == &other_ ? 1 : 0;
  }
  EXPECT_GT(fields, 20U) << "while the contact begins";
  SessionTick tick, last;
  std::uint64_t begun = 0;
  for (bool first = true; channels_->recording->pop(tick); first = false, last = tick) {
    const bool begins = !first && tick.engine != last.engine;
    EXPECT_EQ(tick.tick.index, first || begins ? 0U : last.tick.index + 1);
    if (!begins) continue;
    ++begun;
    EXPECT_EQ(last.tick.input.shutting_down, kHandsOver);
    EXPECT_EQ(tick.tick.input.shutting_down, 0U);
  }
  EXPECT_EQ(begun, 1U);
}

TEST_F(TickSwap, AllocatesNothing) {
  press(300);
  forces_.reserve(forces_.size() + 1000);
  std::vector<dds::ToolPose> poses;
  for (int i = 0; i < 400; ++i) poses.push_back(poseAtDepth(0, kDepth));
  const palpate::testing::AllocationGuard guard;
  offer();
  for (const dds::ToolPose& pose : poses) {
    send(pose);
    runOneTick();
    (void)takeFlags();
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_TRUE(taken());
}

}  // namespace
}  // namespace palpate::server::testing
