// SPDX-License-Identifier: Apache-2.0
#include "tools/program/numbers.h"

#include <gtest/gtest.h>

namespace palpate::program {
namespace {

TEST(ParseVector, ReadsThreeNumbers) {
  EXPECT_EQ(parseVector("--at", "0.1,-2e-3,3"), (std::array{0.1, -2e-3, 3.0}));
  EXPECT_EQ(parseVector("--at", "-.001,0,.5"), (std::array{-0.001, 0.0, 0.5}));
}

TEST(ParseVector, RefusesAllElseByOptionAndText) {
  for (const char* text :
       {"", "1", "1,2", "1,2,", "1,2,3,", "1,2,3,4", "1,2,x", "1,2,3x", "1,2,nan", "nan,0,0", "1,inf,3",
        "0,0,1e999", "0x1,0,0", "+1,0,0", "1,,3", "1;2;3", "1,2,3 ", " 1,2,3", "1 ,2,3"}) {
    try {
      (void)parseVector("--at", text);
      ADD_FAILURE() << "'" << text << "' was not refused";
    } catch (const ValueError& error) {
      EXPECT_EQ(std::string(error.what()),
                "--at is '" + std::string(text) + "', expected three finite numbers x,y,z");
    }
  }
}

TEST(Ticks, AreRoundAndCoverTheRange) {
  const auto ticks = niceTicks(0.0, 0.87, 6);
  EXPECT_LE(ticks.front(), 0.0);
  EXPECT_GE(ticks.back(), 0.87);
  EXPECT_NEAR(ticks[1] - ticks[0], 0.2, 1e-12);
}

}  // namespace
}  // namespace palpate::program
