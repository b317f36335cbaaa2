// SPDX-License-Identifier: Apache-2.0
#include "sample_log.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/devices/sim/delays.h"
#include "palpate/testing/files.h"

namespace palpate::latency {
namespace {

TEST(SampleLog, TellsOfEachPoseWhenItsFirstAnswerCame) {
  SampleLog log(4);
  log.answered(8, 90);  // to a pose before the measurement
  log.sent(10, 1'000'000);
  log.answered(10, 1'600'000);
  log.answered(10, 2'600'000);  // the next tick, which knew no newer pose
  log.sent(11, 2'000'000);
  log.sent(13, 4'000'000);  // DDS refused 12
  log.answered(13, 4'500'000);
  log.answered(11, 4'700'000);  // overtaken
  log.answered(13, 4'800'000);
  log.sent(14, 5'000'000);
  log.sent(15, 6'000'000);  // no room
  EXPECT_EQ(log.csv(),
            "seq,sent_s,answered_s,lost\n"
            "0,0.000000000,0.000600000,0\n"
            "1,0.001000000,0.003700000,0\n"
            "3,0.003000000,0.003500000,0\n"
            "4,0.004000000,,1\n");
}

TEST(SampleLog, IsReadByTheSimulation) {
  SampleLog log(500);
  for (int i = 0; i < 500; ++i) {
    const std::int64_t sent_ns = 7'000'000'000 + i * 1'000'000;
    log.sent(100 + static_cast<std::uint64_t>(i), sent_ns);
    if (i % 50 != 49) log.answered(100 + static_cast<std::uint64_t>(i), sent_ns + 1'300'000);
  }
  const palpate::testing::TemporaryFile file("samples.csv");
  std::ofstream(file.path()) << log.csv();
  const device::Delays delays = device::Delays::read(file.path());
  EXPECT_EQ(delays.poses(), 500U);
  EXPECT_EQ(delays.lost(), 10U);
  EXPECT_EQ(delays.at(0).lag, 2U);
  EXPECT_EQ(delays.largestLag(), 3U);
}

}  // namespace
}  // namespace palpate::latency
