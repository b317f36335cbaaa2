// SPDX-License-Identifier: Apache-2.0
#include "tools/program/certificate_line.h"

#include <gtest/gtest.h>

namespace palpate::program {
namespace {

TEST(CertificateLine, SaysWhatIsCertified) {
  EXPECT_EQ(
      certificateLine(R"({"samples": 59, "travel": 0.007, "certified_area_fraction": 0.868,
                                "force_error": {"max": 0.004, "bound_95_95": 0.003},
                                "field_error": {"max": 0.009, "bound_95_95": 0.008}})"),
      "certified for touches to 7 mm: force within 0.30 %, field within 0.80 % for 95 % of them, with 95 % "
      "confidence; 86.8 % of them are in the domain");
}

TEST(CertificateLine, ClaimsNoBoundOfTooFewSamples) {
  EXPECT_EQ(certificateLine(R"({"samples": 6, "travel": 0.007, "certified_area_fraction": 0.5,
                                "force_error": {"max": 0.004, "bound_95_95": null},
                                "field_error": {"max": 0.009, "bound_95_95": null}})"),
            "not certified for touches to 7 mm: 6 samples in the domain, a bound takes 59");
}

TEST(CertificateLine, TakesOneWithoutSamples) {
  EXPECT_EQ(certificateLine(R"({"samples": 0, "travel": 0.007, "certified_area_fraction": 0.0,
                                "force_error": null, "field_error": null})"),
            "not certified for touches to 7 mm: 0 samples in the domain, a bound takes 59");
}

TEST(CertificateLine, SaysThatThereIsNone) {
  EXPECT_EQ(certificateLine(""), "not certified: the model file does not state how far its answers are off");
}

TEST(CertificateLine, TakesAnyText) {
  for (const char* text : {"{}", "no JSON", "[1, 2]", R"({"travel": "far"})", R"({"field_error_p95": 0.02})"})
    EXPECT_EQ(certificateLine(text), "certified in a form that this program does not know") << text;
}

}  // namespace
}  // namespace palpate::program
