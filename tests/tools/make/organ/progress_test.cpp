// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/progress.h"

#include <gtest/gtest.h>

#include <future>

namespace palpate::organ::test {
namespace {

using std::chrono::milliseconds;

TEST(Progress, SaysHowLongAndHowLongYet) {
  EXPECT_EQ(progressInWords(12.3, 40), "12 s, about 28 s left");
  EXPECT_EQ(progressInWords(12.3, 0), "12 s");
  EXPECT_EQ(progressInWords(50, 40), "50 s");
}

TEST(Progress, TellsAgainAndAgainUntilItEnds) {
  std::promise<void> third;
  int count = 0;
  {
    const Progress progress(
        [&](const std::string& line) {
          EXPECT_NE(line.find("s left"), std::string::npos) << line;
          if (++count == 3) third.set_value();
        },
        1e6, milliseconds(1), milliseconds(1));
    third.get_future().wait();
  }
  const int told = count;  // its thread has ended
  EXPECT_GE(told, 3);
}

TEST(Progress, OfShortWorkSaysNothing) {
  bool told = false;
  {
    const Progress progress([&](const std::string&) { told = true; }, 0, milliseconds(3600000));
  }
  EXPECT_FALSE(told);
  { const Progress silent(nullptr, 0, milliseconds(0)); }
}

}  // namespace
}  // namespace palpate::organ::test
