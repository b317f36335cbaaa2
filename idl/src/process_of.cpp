// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/process_of.h"

#include <algorithm>

#include "builtin_samples.h"
#include "palpate/idl/printable.h"

namespace palpate::dds {

std::string Process::text() const {
  return name.empty() && host.empty() ? "" : name + " (" + pid + ") on " + host;
}

Process processIn(const dds_qos_t* qos) {
  const auto property = [qos](const char* name) {
    char* value = nullptr;
    if (qos == nullptr || !dds_qget_prop(qos, name, &value)) return std::string();
    const std::string text = printable(value);
    dds_free(value);
    return text;
  };
  return {property("__ProcessName"), property("__Pid"), property("__Hostname")};
}

Process processOf(dds_entity_t participants, dds_instance_handle_t participant) {
  void* sample = nullptr;
  dds_sample_info_t info;
  if (dds_read_instance(participants, &sample, &info, 1, 1, participant) != 1) return {};
  Process process = processIn(static_cast<const dds_builtintopic_participant_t*>(sample)->qos);
  dds_return_loan(participants, &sample, 1);
  return process;
}

ProcessBook::ProcessBook(const Participant& participant)
    : participants_(builtinReader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT)) {}

Process ProcessBook::processOf(dds_entity_t reader, dds_instance_handle_t writer) const {
  dds_builtintopic_endpoint_t* const endpoint = dds_get_matched_publication_data(reader, writer);
  if (endpoint == nullptr) return {};
  Process process = dds::processOf(participants_.handle(), endpoint->participant_instance_handle);
  dds_builtintopic_free_endpoint(endpoint);
  return process;
}

std::vector<dds_instance_handle_t> writersOf(dds_entity_t reader, std::size_t most) {
  std::vector<dds_instance_handle_t> writers(most);
  const dds_return_t count = dds_get_matched_publications(reader, writers.data(), most);
  writers.resize(count < 0 ? 0 : std::min(most, static_cast<std::size_t>(count)));
  return writers;
}

}  // namespace palpate::dds
