// SPDX-License-Identifier: Apache-2.0
// The recording's file: what is written is read, and what was damaged is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <vector>

#include "core/record/record_reader.h"
#include "core/record/record_writer.h"
#include "core/record/recorded_fields.h"
#include "palpate/testing/files.h"

namespace palpate::record {
namespace {

SessionFacts someFacts() {
  SessionFacts facts;
  facts.model = sha256({});
  facts.started_ns = 1'700'000'000'000'000'000;
  facts.config.friction = std::numeric_limits<double>::infinity();
  facts.config.tools = 2;
  facts.engine.answers = 77;
  return facts;
}

// Ticks in which everything changes now and then, and stays now and then.
std::vector<RecordedTick> someTicks(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<RecordedTick> ticks(count);
  RecordedTick tick;
  for (std::size_t i = 0; i < count; ++i) {
    tick.index = i;
    tick.input.dt_ns = 1'000'000 + static_cast<std::int64_t>(random() % 1000);
    tick.woke_ns += i % 40 == 39 ? 5'000'000'000 : tick.input.dt_ns;  // now and then a gap
    if (i % 50 == 49) tick.input.period_ns += 1;
    tick.input.shutting_down = i > count - 10 ? 1 : 0;
    tick.input.has_settings = i % 30 == 29 ? 1 : 0;
    tick.input.field_overflowed = i % 5 == 0 ? 1 : 0;
    if (tick.input.has_settings != 0) tick.input.settings[i % 4].live.friction = number(random);
    for (std::size_t t = 0; t < tick.input.tools.size(); ++t) {
      ToolInput& input = tick.input.tools[t];
      input = ToolInput{};
      if (i % (t + 3) != 0) {
        input.present = 1;
        input.age_ns = static_cast<std::int64_t>(random() % 100000);
        if (i % (t + 2) != 0)
          tick.poses[t] = {7 + i, i % 11 == 0 ? 0 : -static_cast<std::int64_t>(random()),
                           tick.woke_ns - input.age_ns, static_cast<std::uint32_t>(random() % 4)};
        input.flags = i % 7 == 0 ? kPoseOutOfOrder : 0;
        input.position = {0.1 * static_cast<double>(i / 5), i % 4 == 0 ? -0.0 : 0.0, std::nan("")};
      }
      if (i % (t + 2) != 0) continue;
      ToolResult& result = tick.result.tools[t];
      result.flags = random();
      for (double& force : result.force) force = number(random);
      result.penetration = number(random);
    }
    ticks[i] = tick;
  }
  return ticks;
}

void expectSame(const RecordedTick& a, const RecordedTick& b) {
  ASSERT_EQ(a.index, b.index);
  EXPECT_EQ(a.input.dt_ns, b.input.dt_ns);
  EXPECT_EQ(a.woke_ns, b.woke_ns) << a.index;
  EXPECT_EQ(a.poses, b.poses) << a.index;
  EXPECT_EQ(a.input.period_ns, b.input.period_ns);
  EXPECT_EQ(a.input.shutting_down, b.input.shutting_down);
  EXPECT_EQ(a.input.has_settings, b.input.has_settings);
  EXPECT_EQ(a.input.field_overflowed, b.input.field_overflowed);
  if (a.input.has_settings != 0) {
    EXPECT_EQ(a.input.settings[2].live.friction, b.input.settings[2].live.friction);
  }
  for (std::size_t t = 0; t < a.input.tools.size(); ++t) {
    const ToolInput& x = a.input.tools[t];
    const ToolInput& y = b.input.tools[t];
    EXPECT_EQ(x.present, y.present);
    EXPECT_EQ(x.flags, y.flags);
    EXPECT_EQ(x.age_ns, y.age_ns);
    if (x.present != 0) {
      EXPECT_EQ(std::memcmp(&x.position, &y.position, sizeof x.position), 0) << a.index;
    }
    EXPECT_EQ(std::memcmp(&a.result.tools[t], &b.result.tools[t], sizeof(ToolResult)), 0) << a.index;
  }
}

class Recording : public ::testing::Test {
 protected:
  void write(const std::vector<RecordedTick>& ticks, std::uint64_t lost = 0, bool finish = true) const {
    RecordWriter writer(path_, someFacts());
    for (const RecordedTick& tick : ticks) writer.write(tick);
    if (finish) {
      writer.finish(ticks.size() + lost);
    } else {
      writer.flush();
    }
  }

  // Reads all of it. @return the refusal without the file's name, or nothing
  [[nodiscard]] std::string refusal() const {
    try {
      RecordReader reader(path_);
      RecordedTick tick;
      while (reader.next(tick)) {
      }
      return {};
    } catch (const RecordError& error) {
      const std::string line = error.what();
      EXPECT_EQ(line.find(path_.string() + ": "), 0U) << line;
      return line.substr(path_.string().size() + 2);
    }
  }

  void flipBit(std::uint64_t byte, int bit) const {
    std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(static_cast<std::streamoff>(byte));
    const int old = file.get();
    file.seekp(static_cast<std::streamoff>(byte));
    file.put(static_cast<char>(old ^ (1 << bit)));
  }

  palpate::testing::TemporaryFile file_{"record.rec"};
  const std::filesystem::path path_ = file_.path();
};

TEST_F(Recording, IsReadAsItWasWritten) {
  const auto ticks = someTicks(1000);
  write(ticks, 5);
  RecordReader reader(path_);
  EXPECT_EQ(reader.facts().model, someFacts().model);
  EXPECT_EQ(reader.facts().started_ns, someFacts().started_ns);
  EXPECT_EQ(reader.facts().config.tools, 2);
  EXPECT_EQ(reader.facts().engine, someFacts().engine);
  EXPECT_EQ(reader.facts().engine.text(), std::string(PALPATE_VERSION) + ", answers 77");
  EXPECT_TRUE(std::isinf(reader.facts().config.friction));
  RecordedTick tick;
  for (const RecordedTick& wanted : ticks) {
    ASSERT_TRUE(reader.next(tick));
    ASSERT_NO_FATAL_FAILURE(expectSame(wanted, tick));
  }
  EXPECT_FALSE(reader.next(tick));
  EXPECT_EQ(reader.end().ticks, 1000U);
  EXPECT_EQ(reader.end().missing, 5U);
}

TEST_F(Recording, LeavesOutWhatRepeats) {
  std::vector<RecordedTick> ticks(1000);
  for (std::size_t i = 0; i < ticks.size(); ++i) ticks[i].index = i;
  write(ticks);
  EXPECT_LT(std::filesystem::file_size(path_), 1000U * 30U) << "nobody there";
  for (RecordedTick& tick : ticks) tick.input.tools[0].present = 1;
  write(ticks);
  EXPECT_LT(std::filesystem::file_size(path_), 1000U * 50U) << "a tool that stands still in the air";
}

TEST_F(Recording, EveryFlippedBitIsFound) {
  write(someTicks(20));
  const std::uint64_t size = std::filesystem::file_size(path_);
  for (std::uint64_t byte = 0; byte < size; ++byte) {
    const int bit = static_cast<int>(byte % 8);
    flipBit(byte, bit);
    EXPECT_NE(refusal(), "") << "byte " << byte;
    flipBit(byte, bit);
  }
  EXPECT_EQ(refusal(), "");
}

TEST_F(Recording, EveryTruncationIsFound) {
  write(someTicks(20));
  const std::uint64_t size = std::filesystem::file_size(path_);
  for (std::uint64_t left = size; left-- > 0;) {
    std::filesystem::resize_file(path_, left);
    EXPECT_NE(refusal(), "") << left << " bytes left";
  }
}

TEST_F(Recording, WithoutAnEndIsCalledTruncatedAfterAllItsTicks) {
  write(someTicks(20), 0, false);
  EXPECT_NE(refusal().find("truncated after byte"), std::string::npos) << refusal();
  EXPECT_NE(refusal().find("20 ticks and no end"), std::string::npos) << refusal();
}

TEST_F(Recording, RefusesWhatItIsNot) {
  std::ofstream(path_) << "not a recording of anything";
  EXPECT_EQ(refusal(), "is no recording of palpate-server");
  write(someTicks(3));
  std::fstream(path_, std::ios::binary | std::ios::in | std::ios::out).seekp(8).put(9);
  EXPECT_NE(
      refusal().find("version 9 of the recording; this program reads version 7: record the session again"),
      std::string::npos)
      << refusal();
  write(someTicks(3));
  std::ofstream(path_, std::ios::app) << "more";
  EXPECT_NE(refusal().find("something follows the end"), std::string::npos) << refusal();
  std::filesystem::remove(path_);
  EXPECT_EQ(refusal(), "cannot be read as a file");
}

TEST_F(Recording, RefusesTicksOutOfOrder) {
  auto ticks = someTicks(3);
  ticks[2].index = 1;
  write(ticks);
  EXPECT_NE(refusal().find("tick 1 after tick 1"), std::string::npos) << refusal();
}

TEST(RecordWriter, RefusesAFileThatCannotBeWritten) {
  EXPECT_THROW(RecordWriter("/nonexistent/session.rec", someFacts()), RecordError);
}

TEST(RecordWriter, SaysWhenTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(RecordWriter("/dev/full", someFacts()), RecordError);
}

}  // namespace
}  // namespace palpate::record
