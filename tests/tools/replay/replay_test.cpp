// SPDX-License-Identifier: Apache-2.0
#include "palpate/replay/replay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "palpate/record/record_writer.h"
#include "palpate/testing/synthetic_model.h"

namespace palpate::replay {
namespace {

using record::RecordedTick;

// A session without a server: a tool that presses, slides and leaves, and one that is deep at once.
class Replay : public ::testing::Test {
 protected:
  Replay() : model_(load()) {
    facts_.model_id = model_.attributes().model_id;
    Workspace work(model_, facts_.config);
    RecordedTick tick;
    for (std::uint64_t i = 0; i < 600; ++i) {
      tick.index = i;
      const double t = 1e-3 * static_cast<double>(i);
      tick.input.tools[0].present = 1;
      tick.input.tools[0].position = {0.01 * t, 0.0, 0.0555 - 0.003 * std::sin(5.0 * t)};
      tick.input.tools[0].age_ns = 1000 * static_cast<std::int64_t>(i % 7);
      tick.input.tools[1].present = i > 100 && i < 300 ? 1 : 0;
      tick.input.tools[1].position = {0.053, 0.0, 0.0};
      tick.input.dt_ns = i == 0 ? 0 : 1'000'000 + static_cast<std::int64_t>(i % 13);
      (void)step(model_, work, tick.input, tick.result);
      session_.push_back(tick);
    }
  }

  static MetaModel load() {
    const palpate::testing::TemporaryFile file("replay-model.h5");
    palpate::testing::writeSyntheticModel(file.path());
    return MetaModel::load(file.path());
  }

  // Written and replayed. @param lost  ticks that the end tells of as missing
  [[nodiscard]] Findings replayed(Demand demand = Demand::kWhole, std::uint64_t lost = 0,
                                  bool end = true) const {
    const palpate::testing::TemporaryFile file("replay.rec");
    {
      record::RecordWriter writer(file.path(), facts_);
      for (const RecordedTick& tick : session_) writer.write(tick);
      end ? writer.finish(session_.size() + lost) : writer.flush();
    }
    record::RecordReader reader(file.path());
    return replay(reader, model_, demand);
  }

  MetaModel model_;
  record::SessionFacts facts_;
  std::vector<RecordedTick> session_;
};

TEST_F(Replay, GivesTheSameBits) {
  const Findings findings = replayed();
  EXPECT_EQ(findings.ticks, session_.size());
  EXPECT_EQ(findings.differing, 0U);
  EXPECT_FALSE(findings.first.has_value());
  EXPECT_GT(findings.largest_force, 0.1) << "the session had no contact";
  EXPECT_NEAR(findings.seconds, 0.6, 0.01);
}

TEST_F(Replay, FindsTheLastBitOfANumber) {
  double& force = session_[321].result.tools[0].force[2];
  ASSERT_NE(force, 0.0);
  const double replayed_force = force;
  force = std::nextafter(force, 100.0);
  const Findings findings = replayed();
  EXPECT_EQ(findings.differing, 1U);
  ASSERT_TRUE(findings.first.has_value());
  EXPECT_EQ(findings.first->tick, 321U);
  EXPECT_EQ(findings.first->tool, 0U);
  EXPECT_EQ(findings.first->field, "force[2]");
  EXPECT_EQ(findings.first->recorded, force);
  EXPECT_EQ(findings.first->replayed, replayed_force);
}

TEST_F(Replay, FindsAnInputThatWasAnother) {
  session_[200].input.tools[0].position[2] -= 1e-9;
  const Findings findings = replayed();
  EXPECT_GE(findings.differing, 1U);
  EXPECT_EQ(findings.first->tick, 200U);
}

TEST_F(Replay, RefusesAnotherModel) {
  facts_.model_id = "another";
  EXPECT_THROW((void)replayed(), record::RecordError);
  EXPECT_THROW((void)replayed(Demand::kPartial), record::RecordError);
}

TEST_F(Replay, RefusesMissingTicksUnlessToldThatTheyMayBe) {
  session_.erase(session_.begin(), session_.begin() + 50);
  EXPECT_THROW((void)replayed(Demand::kWhole, 50), record::RecordError);
  const Findings findings = replayed(Demand::kPartial, 50);
  EXPECT_EQ(findings.missing, 50U);
  EXPECT_EQ(findings.ticks, 550U);
}

TEST_F(Replay, RefusesTicksMissingAtTheEnd) {
  EXPECT_THROW((void)replayed(Demand::kWhole, 3), record::RecordError);
  EXPECT_EQ(replayed(Demand::kPartial, 3).missing, 3U);
}

TEST_F(Replay, RefusesARecordingWithoutTicks) {
  session_.clear();
  for (const Demand demand : {Demand::kWhole, Demand::kPartial})
    for (const bool end : {true, false}) try {
        (void)replayed(demand, 0, end);
        ADD_FAILURE() << "nothing was compared, and nobody complains";
      } catch (const record::TruncatedError&) {
        EXPECT_TRUE(demand == Demand::kWhole && !end);
      } catch (const record::RecordError& error) {
        EXPECT_NE(std::string(error.what()).find("holds no ticks"), std::string::npos) << error.what();
      }
}

TEST_F(Replay, RefusesAMissingEndUnlessToldThatItMayBe) {
  EXPECT_THROW((void)replayed(Demand::kWhole, 0, false), record::TruncatedError);
  const Findings findings = replayed(Demand::kPartial, 0, false);
  EXPECT_TRUE(findings.truncated);
  EXPECT_EQ(findings.ticks, session_.size());
  EXPECT_EQ(findings.differing, 0U);
}

}  // namespace
}  // namespace palpate::replay
