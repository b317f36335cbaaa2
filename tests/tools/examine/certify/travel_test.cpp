// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/travel.h"

#include <gtest/gtest.h>

#include "tools/examine/certify/certify_error.h"

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
  for (const char* without : {"no JSON", "[]", R"({"mesh": "l.msh"})"})
    EXPECT_EQ(travelIn(without, 50e3), 0.005) << without;
}

TEST(Travel, OfAModelIsRefusedWhereItIsNone) {
  for (const char* wrong : {"null", "-1", "0", "0.2", "1e-10", "\"far\""}) {
    const std::string provenance = R"({"travel": )" + std::string(wrong) + "}";
    EXPECT_EQ(travelIn(provenance, 50e3, 0.003), 0.003);
    try {
      (void)travelIn(provenance, 50e3);
      FAIL() << wrong;
    } catch (const CertifyError& error) {
      EXPECT_EQ(error.what(),
                "attribute provenance, /travel is " + std::string(wrong) + ", expected 1e-09 to 0.1 m");
    }
  }
}

}  // namespace
}  // namespace palpate::certify
