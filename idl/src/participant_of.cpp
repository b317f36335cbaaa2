// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/participant_of.h"

#include <algorithm>
#include <iterator>

namespace palpate::dds {

std::optional<ParticipantId> participantOf(dds_entity_t reader, WriterId writer) {
  dds_builtintopic_endpoint_t* const endpoint = dds_get_matched_publication_data(reader, writer);
  if (endpoint == nullptr) return std::nullopt;
  ParticipantId id;
  std::copy(std::begin(endpoint->participant_key.v), std::end(endpoint->participant_key.v), id.begin());
  dds_builtintopic_free_endpoint(endpoint);
  return id;
}

}  // namespace palpate::dds
