// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/rival_watch.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "palpate/rt/clock.h"

namespace palpate::server {
namespace {

using rt::kMs;
constexpr std::int64_t kSayEvery = 100 * kMs;
constexpr std::int64_t kForAName = 1500 * kMs;  // a server says its status once a second

void heardStatus(const dds::ServerStatus& said, dds::WriterId writer, void* book) noexcept {
  static_cast<RivalBook*>(book)->heardStatus(said, writer, rt::monotonicNow());
}

}  // namespace

RivalWatch::RivalWatch(const dds::Participant& participant, const Facts& facts, StatusPublisher& status,
                       double seconds)
    : domain_(participant.domain()),
      own_guid_(participant.guid()),
      book_(facts),
      statuses_(participant, &heardStatus, &book_, dds::Hears::kOthers),
      forces_(
          participant,
          [](const dds::ToolForce& force, dds::WriterId writer, void* book) noexcept {
            static_cast<RivalBook*>(book)->heardForce(force, writer, rt::monotonicNow());
          },
          &book_, dds::Hears::kOthers) {
  if (seconds <= 0.0) return;
  // Servers say once a second what they answer; while this one listens it also wants what they said last.
  const dds::Tap<dds::ServerStatus> last(participant, &heardStatus, &book_, dds::Hears::kOthers,
                                         dds::Wants::kHistory);
  takePlace(status, seconds);
}

void RivalWatch::takePlace(StatusPublisher& status, double seconds) const {
  const std::int64_t begin_ns = rt::monotonicNow();
  const std::int64_t end_ns = begin_ns + static_cast<std::int64_t>(1e9 * seconds);
  std::int64_t say_ns = begin_ns;
  const auto listens = [&](std::int64_t now_ns) {
    return now_ns < end_ns || (now_ns < end_ns + kForAName && hearsNameless(now_ns));
  };
  for (std::int64_t now_ns = begin_ns; listens(now_ns); now_ns = rt::monotonicNow()) {
    if (now_ns >= say_ns) {
      status.publish({}, dds::server_state::kStarting);
      say_ns += kSayEvery;
    }
    if (!hearsNameless(now_ns)) refuseToJoin(now_ns, RivalBook::kGraceNs);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  refuseToJoin(rt::monotonicNow(), 0);
}

/// Forces may come before the status that says whose they are.
bool RivalWatch::hearsNameless(std::int64_t now_ns) const {
  const std::vector<OtherServer> rivals = book_.rivals(now_ns, 0);
  return std::any_of(rivals.begin(), rivals.end(),
                     [](const OtherServer& other) { return other.answers() && !other.hasStatus(); });
}

void RivalWatch::refuseToJoin(std::int64_t now_ns, std::int64_t grace_ns) const {
  for (const OtherServer& other : book_.rivals(now_ns, grace_ns)) {
    if (!other.answers() && !goesFirst(other)) continue;
    throw RivalError(
        "DDS domain " + std::to_string(domain_) + ": " + nameOf(other) +
        (other.answers() ? " answers there already" : " starts at the same time") +
        ". Stop it, choose another --domain, or give both --addressed-only and different --server-id");
  }
}

bool RivalWatch::goesFirst(const OtherServer& other) const {
  const std::string guid = guidOf(other);
  return !guid.empty() && guid < own_guid_;
}

std::string RivalWatch::guidOf(const OtherServer& other) const {
  return other.hasStatus() ? statuses_.participantOf(other.status_writer)
                           : forces_.participantOf(other.force_writer);
}

std::string RivalWatch::nameOf(const OtherServer& other) const {
  const std::string guid = guidOf(other);
  return describe(other) + (guid.empty() ? "" : ", GUID " + guid);
}

RivalNews RivalWatch::poll(std::int64_t now_ns) {
  std::vector<OtherServer> rivals = book_.rivals(now_ns);
  std::erase_if(rivals, [](const OtherServer& other) { return !other.answers(); });
  return {rivals.size(), rivals.empty() ? "" : nameOf(rivals.front()), book_.takeStarter()};
}

}  // namespace palpate::server
