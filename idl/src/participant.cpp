// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/participant.h"

#include <string>
#include <utility>

#include "palpate/idl/error.h"
#include "palpate/idl/raw.h"

namespace palpate::dds {
namespace {

dds_entity_t createParticipant(std::uint32_t domain, const std::optional<Identity>& identity) {
  if (domain > kMaxDomain)
    throw DdsError("DDS domain " + std::to_string(domain) + " is out of range, expected 0 to " +
                   std::to_string(kMaxDomain));
  const QosPtr qos(dds_create_qos());
  if (identity) identity->applyTo(*qos);
  return checked(
      dds_create_participant(domain, qos.get(), nullptr),
      "cannot create a DDS participant on domain " + std::to_string(domain) + " (see CYCLONEDDS_URI)");
}

}  // namespace

std::string Participant::guid() const {
  dds_guid_t guid{};
  checked(dds_get_guid(handle(), &guid), "cannot read a participant's GUID");
  return raw::textOf(guid);
}

Participant::Participant(std::uint32_t domain, std::optional<Identity> identity)
    : domain_(domain), identity_(std::move(identity)), entity_(createParticipant(domain, identity_)) {}

}  // namespace palpate::dds
