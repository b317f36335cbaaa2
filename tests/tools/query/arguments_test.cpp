// SPDX-License-Identifier: Apache-2.0
#include "palpate/query/arguments.h"

#include <gtest/gtest.h>

#include <array>

#include "palpate/query/query_error.h"

namespace palpate::query {
namespace {

TEST(ParseVector, ReadsThreeNumbers) {
  EXPECT_EQ(parseVector("--at", "1,-2.5,3e-3"), Vec3(1.0, -2.5, 3e-3));
  EXPECT_EQ(parseVector("--at", "-.001,0,.5"), Vec3(-0.001, 0.0, 0.5));
}

TEST(ParseVector, RefusesAllElseByOptionAndText) {
  for (const char* text : {"", "1", "1,2", "1,2,", "1,2,3,", "1,2,3,4", "1,2,3x", "1 ,2,3", " 1,2,3", "1,,3",
                           "a,b,c", "nan,0,0", "0,inf,0", "0,0,1e999", "0x1,0,0", "+1,0,0", "1;2;3"}) {
    try {
      (void)parseVector("--displacement", text);
      ADD_FAILURE() << "'" << text << "' was not refused";
    } catch (const QueryError& error) {
      EXPECT_EQ(std::string(error.what()),
                "--displacement is '" + std::string(text) + "', expected three finite numbers x,y,z");
    }
  }
}

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
    } catch (const QueryError& error) {
      EXPECT_EQ(std::string(error.what()),
                "--tool2 is '" + std::string(text) +
                    "', expected a node's number and three finite numbers, NODE:x,y,z");
    }
  }
}

TEST(JoinVectors, KeepsNegativeNumbersFromBeingOptions) {
  constexpr std::array<const char*, 2> kOptions{"--at", "--displacement"};
  const std::array<const char*, 7> words{"model.h5", "--at",    "-.1,0,0", "--displacement=-1,0,0",
                                         "--json",   "--steps", "3"};
  const std::vector<std::string> expected{"model.h5", "--at=-.1,0,0", "--displacement=-1,0,0",
                                          "--json",   "--steps",      "3"};
  EXPECT_EQ(joinVectors(words, kOptions), expected);
}

TEST(JoinVectors, LeavesAnOptionWithoutValueToTheParser) {
  constexpr std::array<const char*, 1> kOptions{"--at"};
  EXPECT_EQ(joinVectors(std::array<const char*, 2>{"--at", "--json"}, kOptions),
            (std::vector<std::string>{"--at", "--json"}));
  EXPECT_EQ(joinVectors(std::array<const char*, 1>{"--at"}, kOptions), std::vector<std::string>{"--at"});
}

}  // namespace
}  // namespace palpate::query
