// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/endpoint_watch.h"

#include <algorithm>
#include <array>
#include <memory>

#include "builtin_samples.h"
#include "palpate/idl/endpoint_fit.h"
#include "palpate/idl/error.h"
#include "palpate/idl/identity.h"
#include "palpate/idl/printable.h"
#include "palpate/idl/process_of.h"
#include "palpate/idl/qos.h"
#include "palpate/idl/raw.h"

namespace palpate::dds {
namespace {

using Other = dds_builtintopic_endpoint_t;

QosPtr qosOf(dds_entity_t entity) {
  QosPtr qos(dds_create_qos());
  (void)dds_get_qos(entity, qos.get());
  return qos;
}

std::string reason(dds_entity_t ours, bool ours_writes, const std::string& our_type, const Other& other) {
  if (our_type != other.type_name)
    return "type (" + printable(other.type_name) + " instead of " + our_type + ")";
  const QosPtr qos = qosOf(ours);
  const std::string policies =
      ours_writes ? policiesInTheWay(qos.get(), other.qos) : policiesInTheWay(other.qos, qos.get());
  if (!policies.empty()) return policies;
  return hasIdentity(dds_get_participant(ours))
             ? "type or permissions (another version of palpate.idl, or its identity's role may not?)"
             : "type (another version of palpate.idl?)";
}

}  // namespace

EndpointWatch::EndpointWatch(dds_entity_t participant, std::chrono::milliseconds patience)
    : patience_(patience),
      writers_(builtinReader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION)),
      readers_(builtinReader(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION)),
      participants_(builtinReader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT)) {
  checked(dds_get_instance_handle(participant, &own_), "cannot tell the participant from others");
}

void EndpointWatch::add(dds_entity_t endpoint, bool writes) {
  const dds_entity_t topic = dds_get_topic(endpoint);
  std::array<char, 256> name{}, type{};
  (void)dds_get_name(topic, name.data(), name.size());
  (void)dds_get_type_name(topic, type.data(), type.size());
  ours_.push_back({endpoint, writes, name.data(), type.data()});
}

std::vector<std::string> EndpointWatch::poll(Clock::time_point now) {
  look(writers_.handle(), true, now);
  look(readers_.handle(), false, now);
  std::vector<std::string> lines;
  const auto judged = std::stable_partition(suspects_.begin(), suspects_.end(),
                                            [&](const Suspect& s) { return now - s.found < patience_; });
  for (auto suspect = judged; suspect != suspects_.end(); ++suspect)
    if (!fitsOneOfOurs(suspect->endpoint, suspect->writes)) lines.push_back(suspect->text);
  suspects_.erase(judged, suspects_.end());
  return lines;
}

void EndpointWatch::look(dds_entity_t builtin, bool writes, Clock::time_point now) {
  const std::size_t room = kMostAtOnce - suspects_.size();
  if (room == 0) return;
  const BuiltinSamples found(builtin, room);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const dds_instance_handle_t endpoint = found.instance(i);
    if (const auto* other = found.alive<Other>(i)) {
      note(*other, endpoint, writes, now);
    } else {  // it left
      std::erase_if(suspects_, [&](const Suspect& s) { return s.endpoint == endpoint; });
    }
  }
}

void EndpointWatch::note(const Other& other, dds_instance_handle_t endpoint, bool writes,
                         Clock::time_point now) {
  if (other.participant_instance_handle == own_) return;  // some of ours hear others only (Hears::kOthers)
  const auto ours = std::find_if(ours_.begin(), ours_.end(), [&](const Ours& one) {
    return one.writes != writes && one.topic == other.topic_name;
  });
  if (ours == ours_.end() || fitsOneOfOurs(endpoint, writes)) return;
  suspects_.push_back({endpoint, writes,
                       std::string("found a ") + (writes ? "writer" : "reader") + " of " + ours->topic +
                           " that does not fit: " + reason(ours->handle, ours->writes, ours->type, other) +
                           "; it is " + raw::textOf(other.key) + owner(other.participant_instance_handle),
                       now});
}

bool EndpointWatch::fitsOneOfOurs(dds_instance_handle_t endpoint, bool writes) const {
  return std::any_of(ours_.begin(), ours_.end(), [&](const Ours& one) {
    if (one.writes == writes) return false;
    Other* match = writes ? dds_get_matched_publication_data(one.handle, endpoint)
                          : dds_get_matched_subscription_data(one.handle, endpoint);
    if (match != nullptr) dds_builtintopic_free_endpoint(match);
    return match != nullptr;
  });
}

// Of participants that are not Cyclone's there is no more than the endpoint's GUID.
std::string EndpointWatch::owner(dds_instance_handle_t participant) const {
  const std::string process = processOf(participants_.handle(), participant).text();
  return process.empty() ? "" : ", process " + process;
}

}  // namespace palpate::dds
