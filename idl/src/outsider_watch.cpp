// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/outsider_watch.h"

#include <algorithm>

#include "builtin_samples.h"
#include "palpate/idl/error.h"
#include "palpate/idl/printable.h"
#include "palpate/idl/process_of.h"
#include "palpate/idl/raw.h"

namespace palpate::dds {
namespace {

// Where its packets come from, as DDS resolved it.
std::string addressOf(const dds_builtintopic_participant_t& participant) {
  char* value = nullptr;
  if (participant.qos == nullptr || !dds_qget_prop(participant.qos, "__NetworkAddresses", &value)) return {};
  const std::string text = printable(value);
  dds_free(value);
  return text;
}

std::string nameOf(const dds_builtintopic_participant_t& participant) {
  return "participant " + raw::textOf(participant.key) + " at " + addressOf(participant);
}

// Only a program without an identity says its process. Of the others Cyclone does not tell whether they were authenticated.
std::string complaintAbout(const dds_builtintopic_participant_t& participant) {
  const std::string process = processIn(participant.qos).text();
  if (!process.empty())
    return ", process " + process + ", is not let in: it has no identity; start it with --security";
  return " shows no topic: it is not let in (no identity of this authority, an expired or a forged one), "
         "does not let us "
         "in, has none, or its handshake is not over";
}

}  // namespace

OutsiderWatch::OutsiderWatch(const Participant& participant, std::chrono::milliseconds patience)
    : patience_(patience),
      participants_(builtinReader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT)),
      writers_(builtinReader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION)),
      readers_(builtinReader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION)) {
  checked(dds_get_instance_handle(participant.handle(), &own_), "cannot tell the participant from others");
}

std::vector<std::string> OutsiderWatch::poll(Clock::time_point now) {
  std::vector<std::string> lines;
  lookForParticipants(now);
  lookForEndpoints(writers_.handle(), lines);
  lookForEndpoints(readers_.handle(), lines);
  const auto judged = std::stable_partition(found_.begin(), found_.end(),
                                            [&](const Found& f) { return now - f.found < patience_; });
  for (auto one = judged; one != found_.end(); ++one) {
    if (in_.contains(one->participant)) continue;
    lines.push_back(one->name + one->complaint);
    out_[one->participant] = one->name;
  }
  found_.erase(judged, found_.end());
  return lines;
}

void OutsiderWatch::lookForParticipants(Clock::time_point now) {
  const std::size_t room = kMostAtOnce - found_.size();
  if (room == 0) return;
  const BuiltinSamples taken(participants_.handle(), room);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const dds_instance_handle_t handle = taken.instance(i);
    if (handle == own_) continue;
    const auto is_it = [handle](const Found& f) { return f.participant == handle; };
    if (const auto* const participant = taken.alive<dds_builtintopic_participant_t>(i)) {
      if (!out_.contains(handle) && std::none_of(found_.begin(), found_.end(), is_it))
        found_.push_back({handle, nameOf(*participant), complaintAbout(*participant), now});
    } else {  // it left
      std::erase_if(found_, is_it);
      in_.erase(handle);
      out_.erase(handle);
    }
  }
}

// Only who was let in has endpoints here.
void OutsiderWatch::lookForEndpoints(dds_entity_t builtin, std::vector<std::string>& lines) {
  for (std::size_t taken_now = kMostAtOnce; taken_now == kMostAtOnce;) {
    const BuiltinSamples taken(builtin, kMostAtOnce);
    taken_now = taken.size();
    for (std::size_t i = 0; i < taken_now; ++i) {
      const auto* const endpoint = taken.alive<dds_builtintopic_endpoint_t>(i);
      if (endpoint == nullptr) continue;
      in_.insert(endpoint->participant_instance_handle);
      const auto told = out_.extract(endpoint->participant_instance_handle);
      if (told) lines.push_back(told.mapped() + " shows topics now: it is let in");
    }
  }
}

}  // namespace palpate::dds
