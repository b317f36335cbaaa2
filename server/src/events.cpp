// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/events.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "core/base/status_flags.h"
#include "event_kinds.h"
#include "palpate/rt/clock.h"
#include "palpate/rt/phase_lock.h"
#include "palpate/rt/scheduling.h"
#include "palpate/server/startup.h"

namespace palpate::server {
namespace {

using rt::kMs;
constexpr std::int64_t kPoll = 20 * kMs;
constexpr std::int64_t kStatusPeriod = 1000 * kMs;
constexpr std::int64_t kChangePeriod = 100 * kMs;  // the shortest time between two status samples
constexpr std::int64_t kWarnPeriod = 1000 * kMs;
constexpr std::int64_t kRivalPeriod = 60'000 * kMs;

// Requests to other servers in a second that are no flood yet.
constexpr std::uint64_t kManyRequests = 200;

}  // namespace

void Events::run() noexcept {
  bool stopping = false;
  while (!stopping) {
    (void)channels_.events_ready.waitFor(kPoll);
    stopping = channels_.stopping.load(std::memory_order_acquire);  // SYNC STOP
    const std::int64_t now_ns = rt::monotonicNow();
    drain(now_ns);
    raiseLateThreads(now_ns);
    if (rest_surface_ != nullptr && !rest_surface_->repeatIfAsked(now_ns))
      channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
    if (!stopping) publishIfDue(now_ns);
  }
  info(channels_.zero_force_out.load(std::memory_order_relaxed) ? "stopping: zero force was sent"
                                                                : "stopping: zero force could not be sent");
  status_.publish(health_, dds::server_state::kStopping);
}

void Events::drain(std::int64_t now_ns) {
  const ParameterNews news = parameters_.poll();
  if (news.refused) warn(kRefusedKind, *news.refused, now_ns);
  if (news.announced) {
    if (isDue(kAnnouncedKind, now_ns)) info(*news.announced);
    noteParameters();
  }
  if (news.changed) {
    if (isDue(kChangedKind, now_ns)) info(*news.changed);
    noteParameters();
  }
  if (news.model) {
    info(*news.model);
    noteParameters();
  }
  noteDelays(now_ns);
  TickRecord record;
  while (channels_.ticks.pop(record)) noteTick(record, now_ns);
  noteLateTicks(now_ns);
  noteClockSteps(now_ns);
  noteOwners();
  noteUnknownTools(now_ns);
  noteMisaddressed(now_ns);
  noteRequestFloods(now_ns);
  noteRivals(now_ns);
  noteRecording(now_ns);
  noteMisfits(now_ns);
  noteSecurity(now_ns);
  const std::uint64_t failed = channels_.failed_writes.load(std::memory_order_relaxed);
  if (failed > health_.failed_writes) {
    warn(kFailedWriteKind, "DDS refused to send (" + std::to_string(failed) + " so far)", now_ns);
  }
  health_.failed_writes = failed;
}

void Events::noteParameters() {
  changed_ = changed_ || health_.parameters_revision != parameters_.book().revision();
  health_.settings = parameters_.book().inForce();
  health_.parameters_revision = parameters_.book().revision();
}

// An endpoint is reported once.
void Events::noteMisfits(std::int64_t now_ns) {
  if (endpoints_ != nullptr) warnInTurn(kMisfitKind, endpoints_->poll(), misfits_, now_ns);
}

void Events::noteSecurity(std::int64_t now_ns) {
  if (security_ == nullptr) return;
  // Rare by itself, and strangers cannot bring it: never left out.
  if (const std::string end = security_->pollOwn(now_ns); !end.empty()) warn(end);
  warnInTurn(kOutsiderKind, security_->pollOthers(), outsiders_, now_ns);
  warnInTurn(kDdsLineKind, security_->pollLines(), dds_lines_, now_ns);
}

void Events::noteUnknownTools(std::int64_t now_ns) {
  const std::uint64_t unknown = channels_.unknown_poses.load(std::memory_order_relaxed);
  if (unknown == health_.unknown_tools) return;
  health_.unknown_tools = unknown;
  health_.recent_flags |= kUnknownTool;
  const std::uint32_t id = channels_.unknown_id.load(std::memory_order_relaxed);
  warn(kUnknownToolKind,
       "pose of tool " + std::to_string(id) + ": tool ids are 0 to " + std::to_string(kMaxTools - 1) +
           ", no force (" + std::to_string(unknown) + " so far)",
       now_ns);
}

// Once: where several servers share a domain, poses for the others are no fault.
void Events::noteMisaddressed(std::int64_t now_ns) {
  const std::uint64_t poses = channels_.misaddressed_poses.load(std::memory_order_relaxed);
  if (health_.misaddressed_poses == 0 && poses > 0) {
    const std::uint32_t id = channels_.misaddressed_id.load(std::memory_order_relaxed);
    warn(kMisaddressedKind,
         "poses for " + (id == dds::kServerAny ? "any server" : "server " + std::to_string(id)) +
             " come in; this is server " + std::to_string(status_.facts().server_id) +
             ", they are not answered",
         now_ns);
  }
  health_.misaddressed_poses = poses;
}

void Events::noteRequestFloods(std::int64_t now_ns) {
  if (now_ns - requests_counted_ns_ < kWarnPeriod) return;
  requests_counted_ns_ = now_ns;
  const std::uint64_t foreign = channels_.foreign_requests.load(std::memory_order_relaxed);
  const std::uint64_t surplus = channels_.surplus_requests.load(std::memory_order_relaxed);
  if (surplus != health_.surplus_requests)
    warn(kRequestFloodKind,
         "parameter requests: " + std::to_string(surplus) + " dropped so far, more than " +
             std::to_string(ParameterService::kPerSecond) + " came in a second",
         now_ns);
  else if (foreign - foreign_requests_ > kManyRequests)
    warn(kRequestFloodKind,
         "parameter requests for other servers: " + std::to_string(foreign - foreign_requests_) +
             " in a second, not looked at",
         now_ns);
  health_.surplus_requests = surplus;
  const std::uint64_t words = channels_.surplus_announcements.load(std::memory_order_relaxed);
  if (words != surplus_announcements_)
    warn(kAnnouncementFloodKind,
         "announcements of devices: " + std::to_string(words) + " dropped so far, more than " +
             std::to_string(AnnouncementBook::kMost) + " hold at once",
         now_ns);
  surplus_announcements_ = words;
  foreign_requests_ = foreign;
}

// A line when a rival appears, one a minute while it is there, one when it is gone.
void Events::noteRivals(std::int64_t now_ns) {
  const RivalNews news = rivals_.poll(now_ns);
  health_.now_ns = now_ns;
  channels_.rival.store(news.count > 0, std::memory_order_relaxed);
  if (news.starter) changed_ = true;  // it listens for whoever answers already
  const bool came = news.count > 0 && health_.rivals == 0;
  if (came) health_.rival_since_ns = now_ns;
  if (came || (news.count > 0 && now_ns - rival_told_ns_ >= kRivalPeriod)) {
    rival_told_ns_ = now_ns;
    warn(kRivalKind, "another server answers the same poses: " + news.text, now_ns);
  }
  if (news.count == 0 && health_.rivals > 0) info("no other server answers the same poses any more");
  health_.rivals = news.count;
  health_.rival = news.text;
}

void Events::noteRecording(std::int64_t now_ns) {
  if (channels_.recording_failed.load(std::memory_order_relaxed) && !recording_failed_) {
    recording_failed_ = true;
    warn(kRecordingFailedKind, "recording ends early: its file cannot be written any more", now_ns);
  }
  const std::uint64_t unrecorded = channels_.unrecorded.load(std::memory_order_relaxed);
  if (unrecorded == unrecorded_ || recording_failed_) return;
  unrecorded_ = unrecorded;
  warn(kUnrecordedKind, "recording: the ring was full (" + std::to_string(unrecorded) + " ticks lost so far)",
       now_ns);
}

void Events::noteTick(const TickRecord& record, std::int64_t now_ns) {
  health_.wakeup.add(record.wakeup_ns);
  if (record.ticks > 1) health_.tick.add(record.previous_tick_ns);
  notePhase(record.phase, now_ns);
  if (record.overruns > health_.last.overruns) {
    warn(kOverrunKind, "ticks missed (" + std::to_string(record.overruns) + " so far)", now_ns);
  }
  if (record.dropped > health_.last.dropped) {
    warn(kDropKind, "a ring was full (" + std::to_string(record.dropped) + " records lost so far)", now_ns);
  }
  for (std::size_t tool = 0; tool < record.flags.size(); ++tool) {
    if (record.seen[tool] == 0) continue;
    if (health_.last.seen[tool] == 0) info("tool " + std::to_string(tool) + ": first pose");
    noteFlags(tool, record.flags[tool], now_ns);
    last_flags_[tool] = record.flags[tool];
    health_.recent_flags |= record.flags[tool];
  }
  health_.last = record;
}

// DDS may make receive threads after the start: for another interface, or for a participant of its own.
void Events::raiseLateThreads(std::int64_t now_ns) {
  if (!raise_receive_threads_ || now_ns - raised_ns_ < kStatusPeriod) return;
  raised_ns_ = now_ns;
  const std::size_t late = rt::raiseThreadsNamed(kReceiveThreads, kReceivePriority);
  if (late > 0) spdlog::info("real time: {} more receive threads of DDS raised", late);
}

// Logs the end of a search for a phase, not the search. If several came within a second, the newest.
void Events::notePhase(std::uint32_t phase, std::int64_t now_ns) {
  const auto state = static_cast<rt::PhaseState>(phase);
  if (phase == told_phase_ || phase == 0 || state == rt::PhaseState::kSeeking) return;
  if (!isDue(kPhaseKind, now_ns)) return;
  told_phase_ = phase;
  if (state == rt::PhaseState::kLocked) info("phase lock: ticks follow the poses");
  if (state == rt::PhaseState::kFree)
    info("phase lock: no poses to follow, or none with a phase of their own: ticks keep their phase");
  if (state == rt::PhaseState::kWaiting)
    info("phase lock: poses come unevenly or not at the ticks' rate, ticks keep their phase for a while");
}

// A tool whose poses end while it touches nothing was let go: no force is taken from a hand, so nothing warns of it.
void Events::noteFlags(std::size_t tool, std::uint32_t flags, std::int64_t now_ns) {
  const std::uint32_t rising = flags & ~last_flags_[tool];
  const bool let_go = ((flags | last_flags_[tool]) & (kInContact | kRamping)) == 0;
  for (const StatusFlag& flag : kStatusFlags) {
    if (flag.log == nullptr || (rising & flag.bit) == 0) continue;
    const std::uint64_t kind = (static_cast<std::uint64_t>(tool) << 32) | flag.bit;
    const std::string whose = "tool " + std::to_string(tool) + ": ";
    if (flag.bit != kStalePose || !let_go)
      warn(kind, whose + flag.log, now_ns);
    else if (isDue(kind, now_ns))
      info(whose + "its poses ended while it touched nothing");
  }
}

bool Events::isDue(std::uint64_t kind, std::int64_t now_ns) {
  const auto [entry, first] = last_told_ns_.try_emplace(kind, now_ns);
  if (!first && now_ns - entry->second < kWarnPeriod) return false;
  entry->second = now_ns;
  return true;
}

void Events::warn(std::uint64_t kind, const std::string& text, std::int64_t now_ns) {
  if (isDue(kind, now_ns)) warn(text);
}

void Events::warn(const std::string& text) {
  spdlog::warn(text);
  health_.message = text;
  changed_ = true;
}

void Events::warnInTurn(std::uint64_t kind, std::vector<std::string> lines, LinesInTurn& waiting,
                        std::int64_t now_ns) {
  waiting.add(std::move(lines));
  if (!waiting.empty() && isDue(kind, now_ns)) warn(waiting.next());
}

void Events::info(const std::string& text) {
  spdlog::info(text);
  health_.message = text;
  changed_ = true;
}

void Events::publishIfDue(std::int64_t now_ns) {
  const std::int64_t since = now_ns - published_ns_;
  if (since < (changed_ ? kChangePeriod : kStatusPeriod)) return;
  status_.publish(health_, dds::server_state::kRunning);
  published_ns_ = now_ns;
  changed_ = false;
  health_.recent_flags = 0;
}

}  // namespace palpate::server
