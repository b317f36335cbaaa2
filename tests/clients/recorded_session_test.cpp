// SPDX-License-Identifier: Apache-2.0
// What palpate-tool plays of a recording, and what it refuses.
#include "recorded_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "core/record/record_writer.h"
#include "palpate/idl/types.h"
#include "palpate/testing/files.h"

namespace palpate::tool {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// 200 ticks. Tool 1 moves from tick 20 on: stamped each 2 ms by a clock of its own, it comes in after 0 to 0.9 ms. Tool 3 is
// there from tick 50 on, with one pose each 10 ms.
class RecordedSessionTest : public ::testing::Test {
 protected:
  RecordedSessionTest() {
    facts_.config.tip_radius = 0.004;
    record::RecordedTick tick;
    for (std::int64_t i = 0; i < 200; ++i) {
      tick.index = static_cast<std::uint64_t>(i);
      tick.input.dt_ns = i == 0 ? 0 : kMs;
      tick.woke_ns = 7'000 * kMs + i * kMs;
      if (i >= 20 && i % 2 == 0)
        pose(tick, 1, -500 * kMs + i * kMs, tick.woke_ns - kMs + i % 10 * 100'000, i);
      if (i >= 50 && i % 10 == 0) pose(tick, 3, 0, tick.woke_ns - 1, i);
      for (ToolResult& result : tick.result.tools) result.force = {0.0, 0.0, 1e-3 * static_cast<double>(i)};
      ticks_.push_back(tick);
    }
  }

  static void pose(record::RecordedTick& tick, std::size_t tool, std::int64_t stamp_ns,
                   std::int64_t arrival_ns, std::int64_t i) {
    tick.input.tools[tool].present = 1;
    tick.input.tools[tool].position = {1e-3 * static_cast<double>(i), 0.0, 0.0};
    tick.input.tools[tool].orientation = {1.0, 0.0, 0.0, 0.0};
    tick.poses[tool] = {static_cast<std::uint64_t>(i), stamp_ns, arrival_ns,
                        static_cast<std::uint32_t>(i % 4)};
  }

  void write(std::uint64_t lost = 0, bool end = true) const {
    record::RecordWriter writer(file_.path(), facts_);
    for (const record::RecordedTick& tick : ticks_) writer.write(tick);
    end ? writer.finish(ticks_.size() + lost) : writer.flush();
  }
  [[nodiscard]] std::string refusal(const Wanted& wanted = {}) const {
    try {
      (void)readSession(file_.path(), wanted);
      return {};
    } catch (const record::RecordError& error) {
      return error.what();
    }
  }

  record::SessionFacts facts_;
  std::vector<record::RecordedTick> ticks_;
  palpate::testing::TemporaryFile file_{"session.rec"};
};

TEST_F(RecordedSessionTest, PosesGoOutAsTheirStampsSay) {
  write();
  const RecordedSession session = readSession(file_.path(), {1, {}, false});
  EXPECT_TRUE(session.by_stamp[1]);
  ASSERT_EQ(session.poses.size(), 90U);
  for (std::size_t i = 0; i < session.poses.size(); ++i) {
    const RecordedPose& pose = session.poses[i];
    EXPECT_EQ(pose.t_ns, static_cast<std::int64_t>(i) * 2 * kMs) << "and not when they came in";
    EXPECT_EQ(pose.tool, 1U);
    EXPECT_EQ(pose.position[0], 1e-3 * (20.0 + 2.0 * static_cast<double>(i)));
    EXPECT_EQ(pose.orientation[0], 1.0);
    EXPECT_EQ(pose.buttons, (20 + 2 * i) % 4);
    EXPECT_EQ(pose.force[2], pose.position[0]) << "that of the first tick that knew it";
  }
  EXPECT_EQ(session.tip_radius[1], 0.004);
}

TEST_F(RecordedSessionTest, WithoutStampsTheyGoOutAsTheyCameIn) {
  write();
  const RecordedSession session = readSession(file_.path(), {3, {}, false});
  EXPECT_FALSE(session.by_stamp[3]);
  ASSERT_EQ(session.poses.size(), 15U);
  for (std::size_t i = 0; i < 15; ++i)
    EXPECT_EQ(session.poses[i].t_ns, static_cast<std::int64_t>(i) * 10 * kMs);
}

TEST_F(RecordedSessionTest, StampsThatAreNoTimingAreNotUsed) {
  for (const std::int64_t stamp : {-499 * kMs,                                // goes back
                                   300 * kMs,                                 // 0.7 s ahead
                                   std::numeric_limits<std::int64_t>::max(),  // no clock
                                   std::numeric_limits<std::int64_t>::min()}) {
    for (std::size_t tick = 100; tick < 102; ++tick) ticks_[tick].poses[1].stamp_ns = stamp;
    write();
    const RecordedSession session = readSession(file_.path(), {1, {}, false});
    EXPECT_FALSE(session.by_stamp[1]) << stamp;
    EXPECT_EQ(session.poses[1].t_ns, 2 * kMs + 200'000) << "as it came in";
  }
}

TEST_F(RecordedSessionTest, ToolsAreSentByOneClock) {
  write();
  const RecordedSession session = readSession(file_.path(), {});
  ASSERT_EQ(session.poses.size(), 105U);
  EXPECT_TRUE(session.has[1] && session.has[3]);
  for (std::size_t i = 1; i < session.poses.size(); ++i)
    EXPECT_LE(session.poses[i - 1].t_ns, session.poses[i].t_ns);
  const auto first = std::find_if(session.poses.begin(), session.poses.end(),
                                  [](const RecordedPose& pose) { return pose.tool == 3; });
  EXPECT_EQ(first->t_ns, 31 * kMs - 1)
      << "tool 1's first pose took least, and came a whole period before its tick";
}

TEST_F(RecordedSessionTest, AFadedForceIsMarked) {
  ticks_[100].result.tools[1].flags = dds::flag::kStalePose;
  for (std::size_t tick = 101; tick < 110; ++tick) ticks_[tick].result.tools[1].flags = dds::flag::kRamping;
  ticks_[150].result.tools[1].flags = dds::flag::kRamping;  // of a contact
  write();
  const RecordedSession session = readSession(file_.path(), {1, {}, false});
  for (const RecordedPose& pose : session.poses)
    EXPECT_EQ(pose.letting_go, pose.position[0] > 0.0999 && pose.position[0] < 0.1095) << pose.position[0];
}

TEST_F(RecordedSessionTest, APartIsPlayed) {
  write();
  const RecordedSession session = readSession(file_.path(), {{}, 0.025, false});
  EXPECT_EQ(session.poses.size(), 13U) << "at 0, 2, .. 24 ms";
  EXPECT_FALSE(session.has[3]) << "it begins later";
}

TEST_F(RecordedSessionTest, TellsOfParametersThatChanged) {
  ticks_[70].input.has_settings = 1;
  write();
  EXPECT_EQ(readSession(file_.path(), {}).changes, 1U);
}

TEST_F(RecordedSessionTest, RefusesWhatIsNotWholeUnlessToldThatItMayBe) {
  write(3);
  EXPECT_NE(refusal().find("session.rec: 3 ticks are missing (--partial plays all the same)"),
            std::string::npos)
      << refusal();
  EXPECT_EQ(readSession(file_.path(), {{}, {}, true}).missing, 3U);
  write(0, false);
  EXPECT_NE(refusal().find("200 ticks and no end (--partial plays what is there)"), std::string::npos)
      << refusal();
  EXPECT_TRUE(readSession(file_.path(), {{}, {}, true}).truncated);
}

TEST_F(RecordedSessionTest, RefusesWhatNoSessionHas) {
  std::ofstream(file_.path()) << "no recording";
  EXPECT_NE(refusal().find("is no recording of palpate-server"), std::string::npos) << refusal();
  write();
  EXPECT_NE(refusal({0, {}, false}).find("no pose of tool 0"), std::string::npos) << refusal({0, {}, false});
  const auto ticks = ticks_;
  ticks_[30].poses[1].arrival_ns = 1;
  write();
  EXPECT_NE(refusal().find("tick 30: tool 1: a pose arrived at 1 ns, the one before at "), std::string::npos)
      << refusal();
  ticks_ = ticks;
  ticks_.back().poses[3].arrival_ns = std::numeric_limits<std::int64_t>::max();
  write();
  EXPECT_NE(refusal().find("tick 199: tool 3: a pose arrived at 9223372036854775807 ns"), std::string::npos)
      << refusal();
  ticks_.back().poses[3].arrival_ns = 90'000'000 * kMs;
  write();
  EXPECT_NE(refusal().find("its poses span 89992 s, more than a day (--seconds plays a part)"),
            std::string::npos)
      << refusal();
  EXPECT_EQ(refusal({{}, 10.0, false}), "");
}

TEST_F(RecordedSessionTest, RefusesOneWithoutPoses) {
  ticks_.resize(10);
  write();
  EXPECT_NE(refusal().find("no pose of any tool"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace palpate::tool
