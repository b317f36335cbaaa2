// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/raw.h"

#include <thread>

#include "palpate/idl/error.h"

namespace palpate::dds::raw {
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
                          const dds_listener_t* listener, Endpoint endpoint, bool ignores_own) {
  const QosPtr qos = makeQos(profile, endpoint);
  if (ignores_own) dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return checked(dds_create_reader(participant, topic, qos.get(), listener),
                 std::string("cannot create a reader of ") + name);
}

unsigned matchedReaders(dds_entity_t writer) noexcept {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK ? status.current_count : 0;
}

std::uint32_t readersOf(dds_entity_t writer) noexcept {
  dds_publication_matched_status_t status{};
  const bool known = dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK;
  return known && status.current_count > 0 ? status.total_count : 0;
}

unsigned matchedWriters(dds_entity_t reader) noexcept {
  dds_subscription_matched_status_t status{};
  return dds_get_subscription_matched_status(reader, &status) == DDS_RETCODE_OK ? status.current_count : 0;
}

std::string textOf(const dds_guid_t& guid) {
  std::string text;
  for (const std::uint8_t byte : guid.v) {
    constexpr const char* kDigits = "0123456789abcdef";
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15U];
  }
  return text;
}

std::string participantGuid(dds_entity_t reader, dds_instance_handle_t writer) {
  dds_builtintopic_endpoint_t* const endpoint = dds_get_matched_publication_data(reader, writer);
  if (endpoint == nullptr) return {};
  const std::string text = textOf(endpoint->participant_key);
  dds_builtintopic_free_endpoint(endpoint);
  return text;
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
