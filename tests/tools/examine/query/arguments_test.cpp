// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/arguments.h"

#include <gtest/gtest.h>

#include "tools/program/numbers.h"

namespace palpate::query {
namespace {

TEST(ParseNodeAndVector, ReadsANodeAndThreeNumbers) {
  const NodeAndVector parsed = parseNodeAndVector("--tool2", "1204:-.001,0,2e-3");
  EXPECT_EQ(parsed.node, 1204);
  EXPECT_EQ(parsed.vector, Vec3(-0.001, 0.0, 2e-3));
}

TEST(ParseNodeAndVector, RefusesAllElseByOptionAndText) {
  for (const char* text : {"", "12", "12:", ":1,2,3", "12:1,2", "12:1,2,3,4", "12.5:1,2,3", "12 :1,2,3",
                           "x:1,2,3", "12:1,2,nan", "99999999999999999999:1,2,3", "12,1,2,3", "12:1,2,3:"}) {
    try {
      (void)parseNodeAndVector("--tool2", text);
      ADD_FAILURE() << "'" << text << "' was not refused";
    } catch (const program::ValueError& error) {
      EXPECT_EQ(std::string(error.what()),
                "--tool2 is '" + std::string(text) +
                    "', expected a node's number and three finite numbers, NODE:x,y,z");
    }
  }
}

}  // namespace
}  // namespace palpate::query
