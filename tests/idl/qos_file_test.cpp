// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "palpate/idl/qos.h"

namespace palpate::dds {
namespace {

std::string policy(const std::string& name, const std::string& kind, const std::string& more = "") {
  std::string upper = name;
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  return "        <" + name + "><kind>" + kind + "_" + upper + "_QOS</kind>" + more + "</" + name + ">\n";
}

std::string endpointText(const char* tag, const dds_qos_t* qos) {
  dds_reliability_kind_t reliability{};
  dds_durability_kind_t durability{};
  dds_history_kind_t history{};
  dds_duration_t blocking = 0;
  std::int32_t depth = 0;
  EXPECT_TRUE(dds_qget_reliability(qos, &reliability, &blocking));
  EXPECT_TRUE(dds_qget_durability(qos, &durability));
  EXPECT_TRUE(dds_qget_history(qos, &history, &depth));
  return std::string("      <") + tag + ">\n" +
         policy("durability", durability == DDS_DURABILITY_VOLATILE ? "VOLATILE" : "TRANSIENT_LOCAL") +
         policy("reliability", reliability == DDS_RELIABILITY_RELIABLE ? "RELIABLE" : "BEST_EFFORT") +
         policy("history", history == DDS_HISTORY_KEEP_LAST ? "KEEP_LAST" : "KEEP_ALL",
                "<depth>" + std::to_string(depth) + "</depth>") +
         "      </" + tag + ">\n";
}

std::string profileText(const char* name, QosProfile profile) {
  return std::string("    <qos_profile name=\"") + name + "\">\n" +
         endpointText("datawriter_qos", makeQos(profile, Endpoint::kWriter).get()) +
         endpointText("datareader_qos", makeQos(profile, Endpoint::kReader).get()) + "    </qos_profile>\n";
}

TEST(QosFile, SaysWhatOurEndpointsHave) {
  std::ifstream file(PALPATE_QOS_FILE);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = text.find("    <qos_profile"), end = text.find("  </qos_library>");
  ASSERT_NE(begin, std::string::npos);
  std::string expected;
  for (const auto& [name, profile] :
       {std::pair("servo", QosProfile::kServo), std::pair("field", QosProfile::kField),
        std::pair("latched", QosProfile::kLatched), std::pair("request", QosProfile::kRequest),
        std::pair("answer", QosProfile::kAnswer)})
    expected += profileText(name, profile);
  EXPECT_EQ(text.substr(begin, end - begin), expected);
}

}  // namespace
}  // namespace palpate::dds
