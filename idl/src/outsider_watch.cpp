// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/outsider_watch.h"

#include <algorithm>
#include <array>

#include "palpate/idl/error.h"
#include "palpate/idl/printable.h"
#include "palpate/idl/process_of.h"
#include "palpate/idl/raw.h"

namespace palpate::dds {
namespace {

Entity builtinReader(const Participant& participant, dds_entity_t topic) {
  return Entity(checked(dds_create_reader(participant.handle(), topic, nullptr, nullptr),
                        "cannot read what DDS discovered"));
}

// Where its packets come from, as DDS resolved it.
std::string addressOf(const dds_builtintopic_participant_t& participant) {
  char* value = nullptr;
  if (participant.qos == nullptr || !dds_qget_prop(participant.qos, "__NetworkAddresses", &value)) return {};
  const std::string text = printable(value);
  dds_free(value);
  return text;
}

// With security, Cyclone says no process before it has authenticated; without, it says it to all.
std::string textOf(const dds_builtintopic_participant_t& participant) {
  const std::string process = processIn(participant.qos).text();
  const std::string who = "participant " + raw::textOf(participant.key) + " at " + addressOf(participant);
  if (!process.empty())
    return who + ", process " + process + ", is not let in: it has no identity; start it with --security";
  return who +
         " is not let in: no identity of this authority, or one that expired or was forged; or it did not "
         "let us in";
}

// Samples of a builtin topic, borrowed.
struct Taken {
  Taken(dds_entity_t builtin, std::size_t most) : reader(builtin) {
    count = dds_take(reader, samples.data(), infos.data(), most, static_cast<std::uint32_t>(most));
  }
  Taken(const Taken&) = delete;
  Taken& operator=(const Taken&) = delete;
  ~Taken() {
    if (count > 0) dds_return_loan(reader, samples.data(), count);
  }
  [[nodiscard]] std::size_t size() const { return count < 0 ? 0 : static_cast<std::size_t>(count); }
  template <class T>
  [[nodiscard]] const T* alive(std::size_t i) const {
    const bool is = infos[i].valid_data && infos[i].instance_state == DDS_IST_ALIVE;
    return is ? static_cast<const T*>(samples[i]) : nullptr;
  }
  dds_entity_t reader;
  std::array<void*, OutsiderWatch::kMostAtOnce> samples{};
  std::array<dds_sample_info_t, OutsiderWatch::kMostAtOnce> infos;
  dds_return_t count;
};

}  // namespace

OutsiderWatch::OutsiderWatch(const Participant& participant, std::chrono::milliseconds patience)
    : patience_(patience),
      participants_(builtinReader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT)),
      writers_(builtinReader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION)),
      readers_(builtinReader(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION)) {
  checked(dds_get_instance_handle(participant.handle(), &own_), "cannot tell the participant from others");
}

std::vector<std::string> OutsiderWatch::poll(Clock::time_point now) {
  lookForParticipants(now);
  lookForEndpoints(writers_.handle());
  lookForEndpoints(readers_.handle());
  std::vector<std::string> lines;
  const auto judged = std::stable_partition(found_.begin(), found_.end(),
                                            [&](const Found& f) { return now - f.found < patience_; });
  for (auto one = judged; one != found_.end(); ++one)
    if (!in_.contains(one->participant)) lines.push_back(one->text);
  found_.erase(judged, found_.end());
  return lines;
}

void OutsiderWatch::lookForParticipants(Clock::time_point now) {
  const std::size_t room = kMostAtOnce - found_.size();
  if (room == 0) return;
  const Taken taken(participants_.handle(), room);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const dds_instance_handle_t handle = taken.infos[i].instance_handle;
    if (handle == own_) continue;
    if (const auto* participant = taken.alive<dds_builtintopic_participant_t>(i)) {
      found_.push_back({handle, textOf(*participant), now});
    } else {  // it left
      std::erase_if(found_, [handle](const Found& f) { return f.participant == handle; });
      in_.erase(handle);
    }
  }
}

// Only who was let in has endpoints here.
void OutsiderWatch::lookForEndpoints(dds_entity_t builtin) {
  for (std::size_t taken_now = kMostAtOnce; taken_now == kMostAtOnce;) {
    const Taken taken(builtin, kMostAtOnce);
    taken_now = taken.size();
    for (std::size_t i = 0; i < taken_now; ++i)
      if (const auto* endpoint = taken.alive<dds_builtintopic_endpoint_t>(i))
        in_.insert(endpoint->participant_instance_handle);
  }
}

}  // namespace palpate::dds
