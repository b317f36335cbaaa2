// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/tick.h"

#include <algorithm>
#include <utility>

#include "palpate/rt/clock.h"

namespace palpate::server {
namespace {

// Answers with zero force before the server ends; several, because best effort may lose some.
constexpr int kZeroTicks = 10;

// How long after its last pose a second publisher is flagged and a stranger answered.
constexpr std::int64_t kRecent = 50'000'000;  // ns

// Age of the poses of a tool that changes hands, for one tick: the force is zero, and begins from nothing.
constexpr std::int64_t kLongAgo = 3'600'000'000'000;  // ns, beyond any zero_after

bool isZero(const std::array<double, 3>& force) noexcept PALPATE_NONBLOCKING {
  return force[0] == 0.0 && force[1] == 0.0 && force[2] == 0.0;
}

}  // namespace

std::int64_t Tick::run(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  // 1. Who answers: another engine, once all forces have gone to zero.
  changeEngine(cycle);
  // 2. What the tools want: the newest pose of each, and its age by our clock. What they feel.
  readPoses(cycle);
  (void)step(engine_->organ, engine_->work, input_, result_);
  countRejectedPoses();
  // 3. One force for each tool seen so far.
  writeForces(cycle);
  // 4. What the surface is made of, if somebody sees it and it changed. Wake the thread that sends forces; it wakes the one
  //    that evaluates the surface.
  writeSurface(cycle);
  channels_.force_ready.post();
  // 5. What went in and came out, for a session that is recorded.
  writeRecording(cycle);
  // 6. The phase of the next tick.
  followPoses(cycle);
  // 7. How it went, for log and status.
  reportTick(cycle);
  // 8. While the server stops: say when all forces are zero.
  reportZeroForce();
  return shift_ns_;
}

// Settings that were written before the other engine was offered go to this one: they are part of the other's beginning.
// So the offer is looked at before them, and at least one tick lies between seeing it and taking it.
void Tick::changeEngine(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  if (next_engine_ == nullptr) {
    Engine* const offered = channels_.next_engine.load(std::memory_order_acquire);  // SYNC ENGINE
    if (offered != engine_) next_engine_ = offered;
    return;
  }
  if (input_.shutting_down != kHandsOver || !allForcesAreZero()) return;
  engine_ = next_engine_;
  next_engine_ = nullptr;
  engine_began_ = cycle.index;
  channels_.engine_in_use.store(engine_->number, std::memory_order_release);  // SYNC TAKEN
}

void Tick::readPoses(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  overrun_ = cycle.overruns > last_overruns_;
  last_overruns_ = cycle.overruns;
  for (std::size_t tool = 0; tool < ledgers_.size(); ++tool) readPose(tool, cycle.woke_ns);
  input_.dt_ns = last_woke_ns_ == 0 ? 0 : cycle.woke_ns - last_woke_ns_;
  input_.has_settings =
      channels_.parameters.read(input_.settings) ? 1 : 0;  // passed once; the engine blends over
  unrehearsed_settings_ = unrehearsed_settings_ || input_.has_settings != 0;
  input_.shutting_down = next_engine_ != nullptr ? kHandsOver : 0;
  if (channels_.shutting_down.load(std::memory_order_relaxed)) input_.shutting_down = 1;
  input_.field_overflowed = channels_.field_overflowed.load(std::memory_order_relaxed) ? 1 : 0;
  last_woke_ns_ = cycle.woke_ns;
}

void Tick::readPose(std::size_t tool, std::int64_t now_ns) noexcept PALPATE_NONBLOCKING {
  Ledger& ledger = ledgers_[tool];
  const std::uint64_t known = ledger.pose.received;
  const std::uint64_t unordered = ledger.pose.unordered;
  const std::uint64_t handed_over = ledger.pose.handed_over;
  (void)channels_.poses[tool].read(ledger.pose);
  ledger.came = ledger.pose.received - known;  // 0 if only a second publisher sent
  if (ledger.came > 0) ledger.superseded += ledger.came - 1;
  ToolInput& input = input_.tools[tool];
  input.present = seen(tool) ? 1 : 0;
  input.position = ledger.pose.position;
  input.orientation = ledger.pose.orientation;
  ledger.changed_hands = ledger.pose.handed_over != handed_over;
  // A pose may arrive between the wake-up and here: it is new, not from the future.
  input.age_ns = ledger.changed_hands ? kLongAgo : std::max<std::int64_t>(0, now_ns - ledger.pose.arrival_ns);
  input.flags = seen(tool) ? noticed(ledger.pose, unordered, now_ns) : 0;
}

std::uint32_t Tick::noticed(const PoseSample& pose, std::uint64_t unordered_before,
                            std::int64_t now_ns) const noexcept PALPATE_NONBLOCKING {
  std::uint32_t flags = overrun_ ? kTickOverrun : 0;
  if (channels_.rival.load(std::memory_order_relaxed)) flags |= kRivalServer;
  if (pose.unordered != unordered_before) flags |= kPoseOutOfOrder;
  if (pose.foreign > 0 && now_ns - pose.foreign_ns <= kRecent) flags |= kTwoPublishers;
  return flags;
}

bool Tick::rejected(std::size_t tool) const noexcept PALPATE_NONBLOCKING {
  return (result_.tools[tool].flags & (kNonFinitePose | kNonUnitQuaternion)) != 0;
}

// The engine was given an old pose of a tool that changed hands, but nobody's poses stopped.
std::uint32_t Tick::told(std::size_t tool) const noexcept PALPATE_NONBLOCKING {
  const std::uint32_t flags = result_.tools[tool].flags;
  return ledgers_[tool].changed_hands ? flags & ~kStalePose : flags;
}

void Tick::countRejectedPoses() noexcept PALPATE_NONBLOCKING {
  for (std::size_t tool = 0; tool < ledgers_.size(); ++tool) {
    if (ledgers_[tool].came > 0 && rejected(tool)) ++rejected_;
  }
}

void Tick::writeForces(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  all_in_ring_ = true;
  for (std::size_t tool = 0; tool < ledgers_.size(); ++tool) {
    if (!seen(tool)) continue;
    Ledger& ledger = ledgers_[tool];
    ForceRecord record;
    record.tool_id = static_cast<std::uint32_t>(tool);
    record.seq = ++ledger.force_seq;
    record.pose_seq = ledger.pose.seq;
    record.pose_stamp_ns = ledger.pose.stamp_ns;
    record.superseded = ledger.superseded;
    record.pose_wait_ns = cycle.woke_ns - ledger.pose.arrival_ns;
    record.result = result_.tools[tool];
    record.result.flags = told(tool);
    push(record, cycle);
  }
  answerStranger(cycle);
}

// One per tick, in turn, so that a tick's cost does not depend on their number.
void Tick::answerStranger(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  (void)channels_.strangers.read(strangers_);
  for (std::size_t tried = 0; tried < strangers_.size(); ++tried) {
    const std::size_t slot = next_stranger_;
    next_stranger_ = (slot + 1) % strangers_.size();
    const Stranger& stranger = strangers_[slot];
    if (stranger.flags == 0 || cycle.woke_ns - stranger.arrival_ns > kRecent) continue;
    ForceRecord record;
    record.tool_id = stranger.tool_id;
    record.seq = ++stranger_seq_[slot];
    record.pose_seq = stranger.seq;
    record.pose_stamp_ns = stranger.stamp_ns;
    record.pose_wait_ns = cycle.woke_ns - stranger.arrival_ns;
    record.result.flags = stranger.flags | (input_.shutting_down == 1 ? kShuttingDown : 0);
    push(record, cycle);
    return;
  }
}

void Tick::push(ForceRecord& record, const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  record.model_hash = engine_->hash;
  record.stamp_ns = cycle.woke_ns;
  record.wakeup_ns = cycle.woke_ns - cycle.deadline_ns;
  record.previous_tick_ns = cycle.previous_ns;
  record.overruns = cycle.overruns;
  record.handed_ns = rt::monotonicNow();
  // A full ring is a lost sample like any other: the receiver sees the gap in seq.
  if (channels_.forces.push(record)) return;
  ++dropped_;
  all_in_ring_ = false;
}

// The tick nearest to the surface's own grid, so that any rate holds on average.
bool Tick::surfaceIsDue(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  if (plan_.surface_period_ns <= plan_.period_ns) return true;
  if (next_surface_ns_ == 0) next_surface_ns_ = cycle.deadline_ns;
  const std::int64_t here_ns = cycle.deadline_ns + plan_.period_ns / 2;
  if (here_ns < next_surface_ns_) return false;
  next_surface_ns_ = rt::nextDeadline(next_surface_ns_, plan_.surface_period_ns, here_ns).ns;
  return true;
}

void Tick::writeSurface(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  const std::uint32_t readers = channels_.field_readers.load(std::memory_order_relaxed);
  if (readers == 0 || !surfaceIsDue(cycle)) return;
  const SurfaceState& surface = engine_->work.surface();
  const bool changed = shown_engine_ != engine_->number || !(surface == handed_over_);
  if (!field_pace_.admits(changed, readers, cycle.woke_ns)) return;
  handed_over_ = surface;
  shown_engine_ = engine_->number;
  SurfaceSample& sample = channels_.surface.back();
  sample.seq = ++surface_seq_;
  sample.stamp_ns = cycle.woke_ns;
  for (std::size_t tool = 0; tool < ledgers_.size(); ++tool)
    sample.poses[tool] = {ledgers_[tool].pose.seq, ledgers_[tool].pose.stamp_ns};
  sample.engine = engine_;
  sample.state = handed_over_;
  channels_.surface.publish();
  channels_.surface_waits.store(true, std::memory_order_relaxed);
}

void Tick::writeRecording(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  if (!channels_.recording) return;
  record::RecordedTick tick{cycle.index - engine_began_, input_, result_, cycle.woke_ns, {}};
  for (std::size_t tool = 0; tool < ledgers_.size(); ++tool) {
    const PoseSample& pose = ledgers_[tool].pose;
    tick.poses[tool] = {pose.seq, pose.stamp_ns, pose.arrival_ns, pose.buttons};
  }
  const std::uint64_t lost = channels_.unrecorded.load(std::memory_order_relaxed);
  if (!channels_.recording->push({tick, engine_->number, lost}))
    channels_.unrecorded.fetch_add(1, std::memory_order_relaxed);
}

// The first tool with a phase sets the ticks' phase until it loses its own; then the first tool that has one follows.
// Rejected poses do not count.
void Tick::followPoses(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  if (!plan_.phase_lock) return;
  std::array<std::int64_t, kMaxTools> shifts{};
  for (std::size_t tool = 0; tool < ledgers_.size(); ++tool) {
    if (!seen(tool)) continue;
    const Ledger& ledger = ledgers_[tool];
    const rt::Arrivals arrivals{rejected(tool) ? 0 : ledger.came, ledger.pose.arrival_ns};
    shifts[tool] = phases_[tool].follow(cycle.deadline_ns, arrivals);
  }
  for (std::size_t tool = 0; tool < ledgers_.size() && !phases_[followed_].hasPhase(); ++tool) {
    if (phases_[tool].hasPhase()) followed_ = tool;
  }
  shift_ns_ = shifts[followed_];
}

void Tick::onRehearsal(void* context) noexcept PALPATE_NONBLOCKING {
  auto& tick = *static_cast<Tick*>(context);
  tick.input_.has_settings = std::exchange(tick.unrehearsed_settings_, false) ? 1 : 0;
  (void)step(tick.engine_->organ, tick.engine_->rehearsal, tick.input_, tick.rehearsed_);
}

void Tick::onLate(void* channels, const rt::LateCycle& cycle) noexcept PALPATE_NONBLOCKING {
  auto& into = *static_cast<Channels*>(channels);
  if (!into.late_cycles.push(cycle)) into.unjudged.fetch_add(1, std::memory_order_relaxed);
}

void Tick::reportTick(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  TickRecord record;
  record.wakeup_ns = cycle.woke_ns - cycle.deadline_ns;
  record.previous_tick_ns = cycle.previous_ns;
  record.phase = plan_.phase_lock ? static_cast<std::uint32_t>(phases_[followed_].state()) : 0;
  record.ticks = cycle.index + 1;
  record.overruns = cycle.overruns;
  record.rejected = rejected_;
  record.dropped = dropped_;
  for (std::size_t tool = 0; tool < ledgers_.size(); ++tool) {
    record.superseded += ledgers_[tool].superseded;
    record.unordered += ledgers_[tool].pose.unordered;
    const Stranger& stranger = strangers_[tool];  // a tool that is not configured is never seen()
    const bool recent = stranger.flags != 0 && cycle.woke_ns - stranger.arrival_ns <= kRecent;
    record.seen[tool] = seen(tool) || stranger.flags != 0 ? 1 : 0;
    record.flags[tool] = told(tool) | (recent ? stranger.flags : 0);
  }
  if (!channels_.ticks.push(record)) ++dropped_;
}

bool Tick::allForcesAreZero() const noexcept PALPATE_NONBLOCKING {
  return std::all_of(result_.tools.begin(), result_.tools.end(),
                     [](const ToolResult& tool) { return isZero(tool.force); });
}

void Tick::reportZeroForce() noexcept PALPATE_NONBLOCKING {
  if (input_.shutting_down != 1) return;
  // Not those that found no room in the ring.
  zero_ticks_ = allForcesAreZero() && all_in_ring_ ? zero_ticks_ + 1 : 0;
  if (zero_ticks_ == kZeroTicks)
    channels_.zero_force_made.store(true, std::memory_order_release);  // SYNC ZERO
}

}  // namespace palpate::server
