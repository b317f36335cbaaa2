// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "core/record/recording.h"
#include "core/tick/step.h"
#include "palpate/rt/late_cause.h"

namespace palpate::server {

struct Engine;

// What crosses from thread to thread: plain arrays, no DDS types. Units and frames as in palpate.idl.

/// Subscriber to tick: the newest pose of one tool, and what happened to those before it.
struct PoseSample {
  std::uint64_t seq{0};                                   ///< sender's counter
  std::int64_t stamp_ns{0};                               ///< sender's clock
  std::int64_t arrival_ns{0};                             ///< our monotonic clock; decides about staleness
  std::array<double, 3> position{};                       ///< p_WT, m
  std::array<double, 4> orientation{0.0, 0.0, 0.0, 1.0};  ///< q_WT, x y z w
  std::uint32_t buttons{0};    ///< bit i: button i is held down; recorded, else unused
  std::uint64_t received{0};   ///< poses of this tool so far, this one included
  std::uint64_t unordered{0};  ///< those of them whose seq went back or repeated, or whose stamp went back
  std::uint64_t foreign{
      0};  ///< poses of a second publisher, between those of the tool's own: counted, not used
  std::int64_t foreign_ns{0};  ///< when the last of those came
  std::uint64_t handed_over{
      0};  ///< times that the tool went to another publisher at once, the former one being gone
};

/// Distinct tool ids above 3 that are answered, with zero force. Further ones are counted and forgotten.
inline constexpr std::size_t kMaxUnknownTools = 16;

/// A tool that gets no force: the newest of its poses.
struct Stranger {
  std::uint32_t tool_id{0};
  std::uint32_t flags{0};  ///< kUnknownTool or kToolNotConfigured; 0: this slot is free
  std::uint64_t seq{0};
  std::int64_t stamp_ns{0};    ///< sender's clock
  std::int64_t arrival_ns{0};  ///< ours
};

/// Subscriber to tick: tools that get no force. Those not configured lie at their id, unknown ones behind them.
using Strangers = std::array<Stranger, kMaxTools + kMaxUnknownTools>;

/// Tick to force-out: one answer.
struct ForceRecord {
  std::uint32_t tool_id{0};
  std::uint64_t seq{0};              ///< this tool's gap-free counter
  std::uint64_t pose_seq{0};         ///< echo
  std::int64_t pose_stamp_ns{0};     ///< echo
  std::int64_t stamp_ns{0};          ///< when the tick woke
  std::int64_t wakeup_ns{0};         ///< how late it woke
  std::int64_t previous_tick_ns{0};  ///< compute time of the tick before
  std::uint64_t overruns{0};
  std::uint64_t superseded{0};   ///< of this tool
  std::uint64_t model_hash{0};   ///< of the model that answers
  std::int64_t pose_wait_ns{0};  ///< from the pose's arrival to the wake-up; below 0: it came after that
  std::int64_t handed_ns{0};     ///< our monotonic clock when the tick handed it over
  ToolResult result;             ///< force on the tool
};

/// A pose that something belongs to.
struct PoseEcho {
  std::uint64_t seq{0};      ///< sender's counter
  std::int64_t stamp_ns{0};  ///< sender's clock; 0: the tool has sent none
};

/// Tick to surface-out: what a field is evaluated from.
struct SurfaceSample {
  std::uint64_t seq{0};
  std::int64_t stamp_ns{0};                 ///< when the tick woke
  std::array<PoseEcho, kMaxTools> poses{};  ///< newest that the tick knew
  Engine* engine{nullptr};                  ///< whose surface it is
  SurfaceState state;
};

/// Tick to recorder: a tick, and the number of the engine that it ran on. Its index counts from that engine's first tick.
struct SessionTick {
  record::RecordedTick tick;
  std::uint64_t engine{0};
  std::uint64_t unrecorded{0};  ///< ticks lost before it, of any engine
};

/// Tick to events: how one tick went. Counters are totals since the start.
struct TickRecord {
  std::int64_t wakeup_ns{0};
  std::int64_t previous_tick_ns{0};  ///< 0 in the first tick
  std::uint32_t phase{0};            ///< rt::PhaseState; 0: phase lock is off
  std::uint64_t ticks{0};            ///< this one included
  std::uint64_t overruns{0};
  std::uint64_t superseded{0};
  std::uint64_t rejected{0};  ///< non-finite or non-unit poses
  std::uint64_t unordered{0};
  std::uint64_t dropped{0};  ///< records lost because a ring was full
  std::array<std::uint8_t, kMaxTools> seen{};
  std::array<std::uint32_t, kMaxTools> flags{};
};

/// Late-watch to events: a late tick, and why.
struct LateTick {
  std::int64_t late_ns{0};  ///< from when it was due until it ended
  std::uint64_t missed{0};  ///< periods
  rt::LateCause cause{rt::LateCause::kUnknown};
  std::array<char, 96> by{};  ///< who had the processor; empty: nobody, or not known
};

static_assert(std::is_trivially_copyable_v<LateTick> && std::is_trivially_copyable_v<PoseSample> &&
              std::is_trivially_copyable_v<Strangers> && std::is_trivially_copyable_v<ForceRecord> &&
              std::is_trivially_copyable_v<TickRecord>);

}  // namespace palpate::server
