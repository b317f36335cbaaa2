// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/travel.h"

#include <gtest/gtest.h>

namespace palpate::certify {
namespace {

double travelIn(const std::string& provenance, double E, std::optional<double> asked = {}) {
  ModelAttributes attributes;
  attributes.provenance = provenance;
  attributes.E = E;
  return travelOf(attributes, asked).length;
}

TEST(Travel, IsTheOneAskedForElseTheCasesElseByStiffness) {
  EXPECT_EQ(travelIn(R"({"travel": 0.006})", 5e3, 0.003), 0.003);
  EXPECT_EQ(travelIn(R"({"travel": 0.006})", 5e3), 0.006);
  EXPECT_EQ(travelIn("{}", 49e3), 0.007);
  EXPECT_EQ(travelIn("{}", 50e3), 0.005);
  for (const char* unusable :
       {"no JSON", "[]", R"({"travel": null})", R"({"travel": -1})", R"({"travel": "far"})"})
    EXPECT_EQ(travelIn(unusable, 50e3), 0.005) << unusable;
}

}  // namespace
}  // namespace palpate::certify
