// SPDX-License-Identifier: Apache-2.0
#include "palpate/program/numbers.h"

#include <gtest/gtest.h>

namespace palpate::program {
namespace {

TEST(ParseVector, ReadsThreeNumbers) {
  EXPECT_EQ(parseVector("--at", "0.1,-2e-3,3"), (std::array{0.1, -2e-3, 3.0}));
}

TEST(ParseVector, RefusesAllElseByOptionAndText) {
  for (const char* text : {"", "1", "1,2", "1,2,", "1,2,3,", "1,2,3,4", "1,2,x", "1,2,nan", "1,inf,3",
                           "1;2;3", "1,2,3 ", " 1,2,3"}) {
    try {
      (void)parseVector("--at", text);
      ADD_FAILURE() << "'" << text << "' was not refused";
    } catch (const ValueError& error) {
      EXPECT_EQ(std::string(error.what()),
                "--at is '" + std::string(text) + "', expected three finite numbers x,y,z");
    }
  }
}

}  // namespace
}  // namespace palpate::program
