// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/delays.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <string>

#include "core/devices/sim/closed_loop.h"
#include "palpate/testing/files.h"

namespace palpate::device {
namespace {

// A pose each millisecond, with what a sender's clock adds, answered after `delay`.
std::vector<DelaySample> steady(double delay, std::size_t count = 1000) {
  std::vector<DelaySample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double sent = 1e-3 * static_cast<double>(i) + (i % 3 == 0 ? 0.0 : 0.2e-3);
    samples.push_back({sent, sent + delay});
  }
  return samples;
}

std::vector<std::size_t> lagsOf(const Delays& delays, std::size_t count) {
  std::vector<std::size_t> lags;
  for (std::size_t i = 0; i < count; ++i) lags.push_back(delays.at(i).lag);
  return lags;
}

TEST(Delays, AnAnswerWithinAPeriodActsInTheNext) {
  const Delays delays(steady(0.6e-3));
  EXPECT_EQ(delays.size(), 999U) << "in the first period nothing acts yet";
  EXPECT_EQ(delays.meanLag(), 1.0);
  EXPECT_EQ(delays.lost() + delays.reordered() + delays.stalled(), 0U);
  for (std::size_t i = 0; i < 2000; ++i) EXPECT_TRUE(delays.at(i).sends);
}

TEST(Delays, ALongerOneActsLater) {
  EXPECT_EQ(Delays(steady(3.5e-3)).meanLag(), 4.0);
  EXPECT_EQ(Delays(steady(3.5e-3)).largestLag(), 4U);
}

TEST(Delays, WhereAnAnswerIsLostTheOneBeforeActsOn) {
  auto samples = steady(0.5e-3);
  samples[10].answered_s.reset();
  samples[11].answered_s.reset();
  const Delays delays(samples);
  EXPECT_EQ(lagsOf(delays, 14), (std::vector<std::size_t>{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 3, 1, 1}));
  EXPECT_EQ(delays.lost(), 2U);
}

TEST(Delays, AnOlderAnswerThatComesLaterActs) {
  auto samples = steady(0.5e-3);
  *samples[10].answered_s += 1.2e-3;  // behind that of pose 11, before pose 12 is sent
  const Delays delays(samples);
  EXPECT_EQ(lagsOf(delays, 13), (std::vector<std::size_t>{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 1}));
  EXPECT_EQ(delays.reordered(), 1U);
}

TEST(Delays, ADriverThatSleepsHoldsItsForceAndSendsNothing) {
  auto samples = steady(0.5e-3);
  samples.erase(samples.begin() + 10, samples.begin() + 13);
  const Delays delays(samples);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(delays.at(i).sends, i < 9 || i > 11) << i;
  EXPECT_EQ(lagsOf(delays, 14), (std::vector<std::size_t>{1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 3, 4, 4, 1}))
      << "what it takes when it wakes is the answer to its last pose";
}

TEST(Delays, WhereTheServerFadesTheForceIsLeftOut) {
  auto samples = steady(0.5e-3);
  for (DelaySample& sample : samples)
    if (sample.sent_s > 0.5) sample.sent_s += 0.1, *sample.answered_s += 0.1;
  const Delays delays(samples);
  EXPECT_EQ(delays.stalled(), 83U) << "100 ms without a pose, less the 18 that a force is held, and the "
                                      "wake-up, which takes an old answer";
  EXPECT_EQ(delays.largestLag(), Delays::kStall - 1);
}

TEST(Delays, OfAFasterSenderTheFirstPoseOfAPeriodCounts) {
  std::vector<DelaySample> samples;
  for (int i = 0; i < 4000; ++i) samples.push_back({0.25e-3 * i, 0.25e-3 * i + 1.9e-3});
  EXPECT_EQ(Delays(samples).meanLag(), 2.0);
}

TEST(Delays, FindTheirWorstStretch) {
  auto samples = steady(0.5e-3);
  for (std::size_t i = 600; i < 650; ++i) *samples[i].answered_s += 3e-3;
  const Delays delays(samples);
  const std::size_t worst = delays.worstStretch(40);
  EXPECT_GE(worst, 600U);
  EXPECT_LE(worst, 612U);
}

TEST(Delays, RefuseTooFew) {
  EXPECT_THROW(Delays(std::vector<DelaySample>{}), std::invalid_argument);
  EXPECT_THROW(Delays(steady(0.5e-3, 100)), std::invalid_argument);
  EXPECT_NO_THROW(Delays(steady(0.5e-3, 101)));
}

// Constant delays are those of the closed loop without a measurement.
TEST(Delays, DelayTheClosedLoopByWholePeriods) {
  const Point surface{0, 0, 0.05}, up{0, 0, 1};
  const Motion motion = makeMotion("press", surface, up, {});
  const auto force_at = [&](const Point& p, bool = true) {
    return Point{0, 0, 300.0 * std::max(0.0, 0.055 - p[2])};
  };
  for (const std::size_t lag : {1, 3}) {
    HeldDevice held({}, {}, motion.path), other = held;
    const Trace by_periods = closedLoop(held, motion, force_at, lag);
    const Delays delays(steady(1e-3 * static_cast<double>(lag) - 0.5e-3));
    const Trace by_measurement = closedLoop(other, motion, force_at, delays, 0);
    EXPECT_EQ(by_periods.position, by_measurement.position) << lag;
    EXPECT_EQ(by_periods.force, by_measurement.force) << lag;
  }
}

class DelayFile : public ::testing::Test {
 protected:
  [[nodiscard]] std::string refusal(const std::string& content) const {
    std::ofstream(file_.path()) << content;
    try {
      (void)Delays::read(file_.path());
      return {};
    } catch (const DelayError& error) {
      const std::string line = error.what();
      EXPECT_EQ(line.find(file_.path().string() + ":"), 0U) << line;
      return line.substr(file_.path().string().size() + 1);
    }
  }
  palpate::testing::TemporaryFile file_{"delays.csv"};
};

constexpr const char* kNames = "seq,sent_s,answered_s,lost\n";

TEST_F(DelayFile, IsReadAsItWasWritten) {
  std::string text = kNames;
  for (int i = 0; i < 200; ++i) {
    const std::string sent = std::to_string(1e-3 * i);
    text += std::to_string(i) + "," + sent + "," +
            (i == 50 ? ",1" : std::to_string(1e-3 * i + 0.0004) + ",0") + "\n";
  }
  ASSERT_EQ(refusal(text), "");
  const Delays delays = Delays::read(file_.path());
  EXPECT_EQ(delays.poses(), 200U);
  EXPECT_EQ(delays.lost(), 1U);
  EXPECT_EQ(delays.largestLag(), 2U);
}

TEST_F(DelayFile, RefusesWhatIsWrongByItsLine) {
  const std::string names = kNames;
  EXPECT_EQ(refusal("t,x\n"), "1: expected the line seq,sent_s,answered_s,lost of palpate-latency --samples");
  EXPECT_EQ(refusal(""), "1: expected the line seq,sent_s,answered_s,lost of palpate-latency --samples");
  EXPECT_EQ(refusal(names + "0,0,0.001,0\nx,1,,1\n"), "3: seq is 'x', expected a number");
  EXPECT_EQ(refusal(names + "5,0,0.001,0\n5,1,,1\n"), "3: seq is 5 after 5");
  EXPECT_EQ(refusal(names + "0,nan,,1\n"), "2: sent_s is nan, expected 0 to 86400 s");
  EXPECT_EQ(refusal(names + "0,-1,,1\n"), "2: sent_s is -1, expected 0 to 86400 s");
  EXPECT_EQ(refusal(names + "0,1,1e9,0\n"), "2: answered_s is 1e9, expected 0 to 86400 s");
  EXPECT_EQ(refusal(names + "0,1,0.5,0\n"), "2: answered_s is 0.5, before the pose was sent");
  EXPECT_EQ(refusal(names + "0,1,,0\n"), "2: answered_s is empty where, and only where, lost is 1");
  EXPECT_EQ(refusal(names + "0,1,2,1\n"), "2: answered_s is empty where, and only where, lost is 1");
  EXPECT_EQ(refusal(names + "0,1,2,yes\n"), "2: lost is 'yes', expected 0 or 1");
  EXPECT_EQ(refusal(names + "0,1,2\n"), "2: lost is '', expected 0 or 1");
  EXPECT_EQ(refusal(names + "0,1,,1\n1,0.5,,1\n"), "3: sent_s is 0.5, before that of the pose before");
  EXPECT_EQ(refusal(names + std::string(300, '1')), "2: is 300 characters long");
  EXPECT_EQ(refusal(names), " there are no poses");
  EXPECT_EQ(refusal(names + "0,0,0.001,0\n1,86400,86400,0\n"),
            " 1 periods of 1 ms with an answer, expected at least 100");
  std::filesystem::remove(file_.path());
  try {
    (void)Delays::read(file_.path());
    ADD_FAILURE();
  } catch (const DelayError& error) {
    EXPECT_EQ(error.what(), file_.path().string() + ": cannot be read as a file");
  }
}

}  // namespace
}  // namespace palpate::device
