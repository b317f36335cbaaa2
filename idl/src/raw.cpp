// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/raw.h"

#include <thread>

#include "palpate/idl/error.h"

namespace palpate::dds::raw {
namespace {

// The policies by which our own topics can fail to match; the numbers are those of the DDS and X-Types
// standards.
std::string policyName(std::uint32_t id) {
  switch (id) {
    case DDS_DEADLINE_QOS_POLICY_ID:
      return "deadline";
    case DDS_LIVELINESS_QOS_POLICY_ID:
      return "liveliness";
    case DDS_RELIABILITY_QOS_POLICY_ID:
      return "reliability";
    case DDS_DURABILITY_QOS_POLICY_ID:
      return "durability";
    case DDS_TYPE_CONSISTENCY_ENFORCEMENT_QOS_POLICY_ID:
      return "type (another version of palpate.idl?)";
    default:
      return "QoS policy " + std::to_string(id);
  }
}

std::string describe(const char* counterpart, const char* name, std::uint32_t policy) {
  return std::string("found a ") + counterpart + " of " + name + " that does not fit: " + policyName(policy);
}

}  // namespace

dds_entity_t createTopic(dds_entity_t participant, const dds_topic_descriptor_t& descriptor,
                         const char* name) {
  return checked(dds_create_topic(participant, &descriptor, name, nullptr, nullptr),
                 std::string("cannot create topic ") + name);
}

dds_entity_t createWriter(dds_entity_t participant, dds_entity_t topic, const char* name,
                          QosProfile profile) {
  return checked(dds_create_writer(participant, topic, makeQos(profile, Endpoint::kWriter).get(), nullptr),
                 std::string("cannot create a writer of ") + name);
}

dds_entity_t createReader(dds_entity_t participant, dds_entity_t topic, const char* name, QosProfile profile,
                          const dds_listener_t* listener) {
  return checked(dds_create_reader(participant, topic, makeQos(profile, Endpoint::kReader).get(), listener),
                 std::string("cannot create a reader of ") + name);
}

unsigned matchedReaders(dds_entity_t writer) noexcept {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK ? status.current_count : 0;
}

unsigned matchedWriters(dds_entity_t reader) noexcept {
  dds_subscription_matched_status_t status{};
  return dds_get_subscription_matched_status(reader, &status) == DDS_RETCODE_OK ? status.current_count : 0;
}

std::string mismatchOfWriter(dds_entity_t writer, const char* name) {
  dds_offered_incompatible_qos_status_t status{};
  if (dds_get_offered_incompatible_qos_status(writer, &status) != DDS_RETCODE_OK || status.total_count == 0)
    return {};
  return describe("reader", name, status.last_policy_id);
}

std::string mismatchOfReader(dds_entity_t reader, const char* name) {
  dds_requested_incompatible_qos_status_t status{};
  if (dds_get_requested_incompatible_qos_status(reader, &status) != DDS_RETCODE_OK || status.total_count == 0)
    return {};
  return describe("writer", name, status.last_policy_id);
}

bool waitUntilMatched(unsigned (*matched)(dds_entity_t) noexcept, dds_entity_t entity, unsigned count,
                      std::chrono::milliseconds timeout) noexcept {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (matched(entity) < count) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace palpate::dds::raw
