// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "authority.h"

namespace palpate::security {
namespace {

constexpr const char* kSchema = "http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_";
constexpr const char* kAllDomains = "<domains><id_range><min>0</min><max>230</max></id_range></domains>\n";

std::string document(const std::string& kind, const std::string& content) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" xsi:noNamespaceSchemaLocation=\"" +
         std::string(kSchema) + kind + ".xsd\">\n" + content + "</dds>\n";
}

}  // namespace

// Each submessage is encrypted whole: samples, and what an attacker could forge to make a reader skip or wait for some. RTPS
// messages are not signed on top of that, nor payloads encrypted once more inside (docs/decisions/security.md).
std::string governance() {
  return document("governance",
                  std::string("<domain_access_rules>\n<domain_rule>\n") + kAllDomains +
                      "<allow_unauthenticated_participants>false</allow_unauthenticated_participants>\n"
                      "<enable_join_access_control>true</enable_join_access_control>\n"
                      "<discovery_protection_kind>ENCRYPT</discovery_protection_kind>\n"
                      "<liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>\n"
                      "<rtps_protection_kind>NONE</rtps_protection_kind>\n"
                      "<topic_access_rules>\n<topic_rule>\n"
                      "<topic_expression>*</topic_expression>\n"
                      "<enable_discovery_protection>true</enable_discovery_protection>\n"
                      "<enable_liveliness_protection>true</enable_liveliness_protection>\n"
                      "<enable_read_access_control>true</enable_read_access_control>\n"
                      "<enable_write_access_control>true</enable_write_access_control>\n"
                      "<metadata_protection_kind>ENCRYPT</metadata_protection_kind>\n"
                      "<data_protection_kind>NONE</data_protection_kind>\n"
                      "</topic_rule>\n</topic_access_rules>\n</domain_rule>\n</domain_access_rules>\n");
}

std::string permissions(dds::Role role, const std::string& subject, const std::string& start,
                        const std::string& end) {
  std::string written;
  for (const std::string_view topic : dds::topicsWrittenBy(role))
    written.append("<topic>").append(topic).append("</topic>");
  if (!written.empty()) written = "<publish><topics>" + written + "</topics></publish>\n";
  return document("permissions", "<permissions>\n<grant name=\"" + std::string(dds::wordOf(role)) +
                                     "\">\n<subject_name>" + subject +
                                     "</subject_name>\n<validity><not_before>" + start +
                                     "</not_before><not_after>" + end +
                                     "</not_after></validity>\n<allow_rule>\n" + kAllDomains + written +
                                     "<subscribe><topics><topic>palpate/*</topic></topics></subscribe>\n"
                                     "</allow_rule>\n<default>DENY</default>\n</grant>\n</permissions>\n");
}

}  // namespace palpate::security
