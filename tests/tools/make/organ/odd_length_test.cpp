// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/odd_length.h"

#include <gtest/gtest.h>

namespace palpate::organ::test {
namespace {

TEST(OddLength, AnOrganIsNotOdd) {
  for (const double length : {0.005, 0.02, 0.2, 1.0}) EXPECT_FALSE(oddLength(length, 1)) << length;
}

TEST(OddLength, SuspectsTheUnitThatMakesAnOrgan) {
  const auto expect = [](double length, double scale, const std::string& part) {
    const std::string words = oddLength(length, scale).value_or("not odd");
    EXPECT_NE(words.find(part), std::string::npos) << words;
  };
  expect(160, 1, "is the file in mm? --unit mm makes it 0.16 m long");
  expect(20, 1, "--unit cm makes it 0.2 m long");
  expect(0.0002, 1e-3, "--unit m makes it 0.2 m long");
  expect(0.002, 1e-4, "the body is 0.002 m long");
  expect(1e9, 1, "is --unit or --scale right?");
}

}  // namespace
}  // namespace palpate::organ::test
