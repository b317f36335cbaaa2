// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/replay/replay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/record/record_writer.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/write_model.h"

namespace palpate::replay {
namespace {

using record::RecordedTick;

// A session without a server: a tool that presses, slides and leaves, and one that is deep at once.
class Replay : public ::testing::Test {
 protected:
  Replay() : model_(load()) {
    facts_.model = model_.digest();
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

TEST_F(Replay, PromisesNothingOfAnotherEngine) {
  EXPECT_FALSE(replayed().other_engine);
  facts_.engine.answers += 1;
  EXPECT_TRUE(replayed(Demand::kPartial).other_engine);
  try {
    (void)replayed();
    ADD_FAILURE() << "the bits of another engine were promised";
  } catch (const record::RecordError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("recorded with engine " + facts_.engine.text() + ", this is engine " +
                        record::thisEngine().text()),
              std::string::npos)
        << error.what();
  }
}

TEST_F(Replay, RefusesAnotherModel) {
  facts_.model.bytes.back() ^= 1U;  // its id begins as that of the model
  EXPECT_THROW((void)replayed(), record::RecordError);
  EXPECT_THROW((void)replayed(Demand::kPartial), record::RecordError);
}

TEST_F(Replay, RefusesAModelOfTheSameNameThatAnswersOtherwise) {
  const palpate::testing::TemporaryFile file("replay-model.h5");  // the name of the recorded one
  modelfile::ModelData data = palpate::testing::syntheticModel();
  for (double& force : data.contact_force) force *= 3.0;
  for (double& stiffness : data.contact_stiffness) stiffness *= 3.0;
  modelfile::writeModel(file.path(), data);
  model_ = MetaModel::load(file.path());
  for (const Demand demand : {Demand::kWhole, Demand::kPartial}) try {
      (void)replayed(demand);
      ADD_FAILURE() << "the other model was replayed";
    } catch (const record::RecordError& error) {
      EXPECT_NE(std::string(error.what()).find("their contents differ"), std::string::npos) << error.what();
    }
}

TEST_F(Replay, RefusesLiveParametersThatTheWireRefuses) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::string, std::function<void(LiveParameters&)>>> cases{
      {"tick 321: tool 1: youngs_modulus is 1e+300, expected ",
       [](LiveParameters& l) { l.youngs_modulus = 1e300; }},
      {"tick 321: tool 1: coupling_stiffness is nan, expected ",
       [](LiveParameters& l) { l.coupling_stiffness = kNaN; }},
      {"tick 321: tool 1: friction is -1, expected 0 to ", [](LiveParameters& l) { l.friction = -1.0; }},
      {"tick 321: tool 1: force_limit is ", [](LiveParameters& l) { l.force_limit = -5.0; }},
      {"tick 321: tool 1: coupling_damping is 50, expected at most 1.5 ",
       [](LiveParameters& l) {
         l.coupling_stiffness = 300.0;
         l.coupling_damping = 50.0;
       }},
      {"tick 321: tool 1: youngs_modulus is 7000.000000, expected that of tool 0, ",
       [](LiveParameters& l) { l.youngs_modulus = 7000.0; }},
  };
  StepInput& input = session_[321].input;
  input.has_settings = 1;
  for (const auto& [expected, spoil] : cases) {
    input.settings = toolSettings(facts_.config);
    spoil(input.settings[1].live);
    for (const Demand demand : {Demand::kWhole, Demand::kPartial}) try {
        (void)replayed(demand);
        ADD_FAILURE() << expected;
      } catch (const record::RecordError& error) {
        EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
      }
  }
}

TEST_F(Replay, RefusesAConfigurationThatTheServerRefuses) {
  facts_.config.ramp_time = 1e300;
  try {
    (void)replayed();
    ADD_FAILURE() << "it was replayed";
  } catch (const record::RecordError& error) {
    EXPECT_NE(std::string(error.what()).find("header: ramp_time is 1e+300, expected 0 to 1 s"),
              std::string::npos)
        << error.what();
  }
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
