// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/recorder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <memory>

#include "core/record/record_reader.h"
#include "palpate/testing/files.h"

namespace palpate::server {
namespace {

class RecorderTest : public ::testing::Test {
 protected:
  [[nodiscard]] record::SessionFacts facts() const {
    record::SessionFacts facts;
    facts.model.bytes.fill(7);
    return facts;
  }

  palpate::testing::TemporaryFile file_{"recorder.rec"};
  const std::filesystem::path path_ = file_.path();
  std::unique_ptr<Channels> channels_ = std::make_unique<Channels>();
};

TEST_F(RecorderTest, WritesWhatLiesInTheRingBeforeItReturns) {
  Recorder recorder(*channels_, path_, facts());
  for (std::uint64_t i = 0; i < 100; ++i) ASSERT_TRUE(channels_->recording->push({{i, {}, {}}, 0}));
  channels_->stopping = true;
  recorder.run();
  EXPECT_EQ(recorder.summary(), "recorded 100 ticks to " + path_.string() + ", 0 lost");
  record::RecordReader reader(path_);
  record::RecordedTick tick;
  while (reader.next(tick)) {
  }
  EXPECT_EQ(reader.end().ticks, 100U);
  EXPECT_EQ(reader.end().missing, 0U);
}

TEST_F(RecorderTest, TicksLostToAFullRingAreToldInTheFile) {
  Recorder recorder(*channels_, path_, facts());
  ASSERT_TRUE(channels_->recording->push({{0, {}, {}}, 0}));
  ASSERT_TRUE(channels_->recording->push({{8, {}, {}}, 0}));
  channels_->unrecorded = 7;
  channels_->stopping = true;
  recorder.run();
  EXPECT_EQ(recorder.summary(), "recorded 2 ticks to " + path_.string() + ", 7 lost");
  record::RecordReader reader(path_);
  record::RecordedTick tick;
  while (reader.next(tick)) {
  }
  EXPECT_EQ(reader.end().missing, 7U);
}

TEST_F(RecorderTest, AnotherModelGoesIntoAnotherFileAndOverwritesNone) {
  const palpate::testing::TemporaryFolder folder;
  (void)folder.write("session-2.rec", "somebody's");
  Recorder recorder(*channels_, folder / "session.rec", facts());
  record::SessionFacts next = facts();
  next.model.bytes.fill(9);
  recorder.expect(1, next);
  for (std::uint64_t i = 0; i < 100; ++i) ASSERT_TRUE(channels_->recording->push({{i, {}, {}}, 0}));
  for (std::uint64_t i = 0; i < 40; ++i) ASSERT_TRUE(channels_->recording->push({{i, {}, {}}, 1}));
  channels_->stopping = true;
  recorder.run();
  EXPECT_EQ(recorder.summary(), "recorded 40 ticks to " + (folder / "session-3.rec").string() +
                                    ", 0 lost; before that " + (folder / "session.rec").string() +
                                    " (100 ticks), of other models");
  EXPECT_EQ(palpate::testing::contentOf(folder / "session-2.rec"), "somebody's");
  const std::pair<const char*, std::pair<std::uint8_t, std::uint64_t>> files[]{{"session.rec", {7, 100}},
                                                                               {"session-3.rec", {9, 40}}};
  for (const auto& [name, holds] : files) {
    record::RecordReader reader(folder / name);
    EXPECT_EQ(reader.facts().model.bytes[0], holds.first);
    record::RecordedTick tick;
    while (reader.next(tick)) {
    }
    EXPECT_EQ(reader.end().ticks, holds.second);
    EXPECT_EQ(reader.end().missing, 0U);
  }
}

TEST_F(RecorderTest, ModelsBeyondAThousandAreRefused) {
  const palpate::testing::TemporaryFolder folder;
  Recorder recorder(*channels_, folder / "session.rec", facts());
  for (int i = 2; i <= Recorder::kMostFiles; ++i)
    EXPECT_EQ(recorder.expect(static_cast<std::uint64_t>(i), facts()),
              folder / ("session-" + std::to_string(i) + ".rec"));
  EXPECT_THROW(recorder.expect(1001, facts()), record::RecordError);
}

TEST_F(RecorderTest, FilesOfAnEarlierSessionDoNotCount) {
  const palpate::testing::TemporaryFolder folder;
  for (int i = 2; i <= Recorder::kMostFiles; ++i)
    std::ofstream(folder / ("session-" + std::to_string(i) + ".rec")) << "another session's";
  Recorder recorder(*channels_, folder / "session.rec", facts());
  EXPECT_EQ(recorder.expect(1, facts()), folder / "session-1001.rec");
}

TEST_F(RecorderTest, TicksLostToAFullRingAreToldInTheFileOfTheirModel) {
  const palpate::testing::TemporaryFolder folder;
  Recorder recorder(*channels_, folder / "session.rec", facts());
  recorder.expect(1, facts());
  recorder.expect(2, facts());
  const auto push = [&](std::uint64_t index, std::uint64_t engine, std::uint64_t unrecorded) {
    ASSERT_TRUE(channels_->recording->push({{index, {}, {}}, engine, unrecorded}));
  };
  push(0, 0, 0);  // nothing of the first is lost
  push(1, 0, 0);
  push(0, 1, 0);
  push(4, 1, 3);  // 3 in between, then the last 2 of this one and the first 5 of the next
  push(5, 2, 10);
  channels_->unrecorded = 11;  // and one at the end
  channels_->stopping = true;
  recorder.run();
  const std::pair<const char*, std::uint64_t> files[]{
      {"session.rec", 0}, {"session-2.rec", 5}, {"session-3.rec", 6}};
  for (const auto& [name, missing] : files) {
    record::RecordReader reader(folder / name);
    record::RecordedTick tick;
    while (reader.next(tick)) {
    }
    EXPECT_EQ(reader.end().missing, missing) << name;
  }
}

TEST_F(RecorderTest, AFileThatCannotGrowEndsTheRecordingAndNotTheServer) {
  Recorder recorder(*channels_, path_, facts());
  ASSERT_TRUE(channels_->recording->push({{5, {}, {}}, 0}));
  channels_->stopping = true;
  const rlimit64 before = [] {
    rlimit64 limit{};
    getrlimit64(RLIMIT_FSIZE, &limit);
    return limit;
  }();
  rlimit64 small = before;
  small.rlim_cur = std::filesystem::file_size(path_);
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit64(RLIMIT_FSIZE, &small);
  recorder.run();
  setrlimit64(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old);
  EXPECT_TRUE(channels_->recording_failed);
  EXPECT_EQ(recorder.summary().find("recording ends early after 1 ticks: " + path_.string() +
                                    ": cannot be written"),
            0U)
      << recorder.summary();
  record::RecordReader reader(path_);
  record::RecordedTick tick;
  EXPECT_THROW((void)reader.next(tick), record::TruncatedError);
}

}  // namespace
}  // namespace palpate::server
