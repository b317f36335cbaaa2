// SPDX-License-Identifier: Apache-2.0
#include "tools/program/certificate_line.h"

#include <gtest/gtest.h>

#include <string>

namespace palpate::program {
namespace {

constexpr const char* kUnknown =
    "not certified: the certificate in the file has a form that this program does not know";

/// One that is right but for one number. @param key  "samples", "travel", "share", "force" or "field"
std::string certificateWith(const std::string& key, const std::string& number) {
  const auto value = [&](const char* name, const char* right) { return name == key ? number : right; };
  return R"({"samples": )" + value("samples", "59") + R"(, "travel": )" + value("travel", "0.007") +
         R"(, "certified_area_fraction": )" + value("share", "0.8") + R"(, "force_error": {"bound_95_95": )" +
         value("force", "0.003") + R"(}, "field_error": {"bound_95_95": )" + value("field", "0.008") + "}}";
}

TEST(CertificateLine, SaysWhatIsCertified) {
  EXPECT_EQ(
      certificateLine(R"({"samples": 59, "travel": 0.007, "certified_area_fraction": 0.868,
                                "force_error": {"max": 0.004, "bound_95_95": 0.003},
                                "field_error": {"max": 0.009, "bound_95_95": 0.008}})"),
      "certified for touches to 7 mm: of touches in the domain, 95 % are within 0.30 % in force and 95 % "
      "within 0.80 % in field, each with 95 % confidence; 86.8 % of touches are in the domain");
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
  for (const char* text :
       {"{}", "no JSON", "[1, 2]", "null", "7", R"({"travel": "far"})", R"({"field_error_p95": 0.02})"})
    EXPECT_EQ(certificateLine(text), kUnknown) << text;
}

TEST(CertificateLine, ClaimsNothingByNumbersThatNoCertificateHas) {
  struct Case {
    const char *key, *wrong;
  };
  EXPECT_EQ(certificateLine(certificateWith("samples", "2000000")).rfind("certified for", 0), 0U);
  for (const auto& [key, wrong] :
       {Case{"samples", "58"}, {"samples", "2000001"}, {"samples", "-1"},   {"samples", "1e300"},
        {"samples", "59.5"},   {"samples", "\"59\""},  {"samples", "null"}, {"travel", "0"},
        {"travel", "-0.007"},  {"travel", "1.1"},      {"travel", "1e999"}, {"travel", "null"},
        {"share", "-0.1"},     {"share", "1.01"},      {"share", "true"},   {"force", "-0.001"},
        {"force", "1e999"},    {"force", "null"},      {"force", "{}"},     {"field", "-1"},
        {"field", "NaN"},      {"field", "null"},      {"field", "\"0\""}})
    EXPECT_EQ(certificateLine(certificateWith(key, wrong)), kUnknown) << key << ' ' << wrong;
}

TEST(CertificateLine, TakesNoTextThatIsLongerThanAFileMayHave) {
  const std::string good = certificateWith("samples", "59");
  const std::string longest = good + std::string(65536 - good.size(), ' ');
  EXPECT_EQ(certificateLine(longest), certificateLine(good));
  EXPECT_EQ(certificateLine(longest + ' '), kUnknown);
}

}  // namespace
}  // namespace palpate::program
