// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/participant.h"

#include <string>

#include "palpate/idl/error.h"
#include "palpate/idl/raw.h"

namespace palpate::dds {
namespace {

dds_entity_t createParticipant(std::uint32_t domain) {
  if (domain > kMaxDomain)
    throw DdsError("DDS domain " + std::to_string(domain) + " is out of range, expected 0 to " +
                   std::to_string(kMaxDomain));
  return checked(
      dds_create_participant(domain, nullptr, nullptr),
      "cannot create a DDS participant on domain " + std::to_string(domain) + " (see CYCLONEDDS_URI)");
}

}  // namespace

std::string Participant::guid() const {
  dds_guid_t guid{};
  checked(dds_get_guid(handle(), &guid), "cannot read a participant's GUID");
  return raw::textOf(guid);
}

Participant::Participant(std::uint32_t domain) : domain_(domain), entity_(createParticipant(domain)) {}

}  // namespace palpate::dds
