// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "palpate/rt/periodic_thread.h"
#include "palpate/rt/semaphore.h"
#include "palpate/rt/spsc_queue.h"
#include "palpate/rt/triple_buffer.h"
#include "palpate/server/records.h"

namespace palpate::server {

/// Everything that two threads of the server share, and nothing is shared but this. Each line names its one
/// writer and one reader. Two more things never change while threads run: a model and the configuration. Outside of the
/// tick, RivalBook, Recorder and ModelLoader have locks of their own.
struct Channels {
  // Subscriber -> events: the writer of each tool's poses; 0: none yet. Relaxed, it orders nothing.
  std::array<std::atomic<std::uint64_t>, kMaxTools> owners{};

  // Subscriber -> tick. Cyclone runs one callback of a reader at a time, so "the subscriber" is one writer
  // even when poses come in on several receive threads.
  std::array<rt::TripleBuffer<PoseSample>, kMaxTools> poses;
  rt::TripleBuffer<Strangers> strangers;

  // Events -> tick: latest wins. What is in it was checked.
  rt::TripleBuffer<AllToolSettings> parameters;

  // Model exchange, on the events thread -> tick: the engine that is to answer from now on. The tick ends all forces, and takes it.
  // SYNC ENGINE: stored with release once it is made, loaded with acquire before the tick looks at parameters.
  std::atomic<Engine*> next_engine{nullptr};

  // Tick -> model exchange: number of the engine in use. SYNC TAKEN: stored with release by the tick that no longer looks at the
  // engine before it, loaded with acquire.
  std::atomic<std::uint64_t> engine_in_use{0};

  // Model exchange -> surface-out: number of the engine in use, once the tick has said so. Surface-out -> model exchange: such a
  // number, once no field of an engine before it is looked at any more. SYNC SHOWN: both with release and acquire.
  std::atomic<std::uint64_t> engine_to_show{0};
  std::atomic<std::uint64_t> engine_shown{0};

  // Tick -> force-out: a ring, because every tick is answered. 2048 records are 128 ms of four tools at
  // 4 kHz.
  rt::SpscQueue<ForceRecord, 2048> forces;
  rt::Semaphore force_ready;

  // Surface-out -> tick: 0 where nobody reads fields, and the tick hands over none; else another number with each reader that
  // comes (dds::Writer::readers()). Relaxed: it orders nothing.
  std::atomic<std::uint32_t> field_readers{0};

  // Surface-out -> tick: the last field was not finite. A flag, relaxed: it orders nothing.
  std::atomic<bool> field_overflowed{false};

  // Tick -> surface-out: latest wins. The tick tells force-out, which wakes surface-out once the forces are sent, so that the
  // two do not run at once. A flag, relaxed: the semaphores order.
  rt::TripleBuffer<SurfaceSample> surface;
  std::atomic<bool> surface_waits{false};
  rt::Semaphore surface_ready;

  // Tick -> events. Polled: the tick does not pay for waking it. 4096 ticks are a second at 4 kHz.
  rt::SpscQueue<TickRecord, 4096> ticks;

  // Tick -> late-watch: ticks that were late. 1024 are a second at 1 kHz. A full ring
  // loses the newest, which the counter says; relaxed, it orders nothing.
  rt::SpscQueue<rt::LateCycle, 1024> late_cycles;
  std::atomic<std::uint64_t> unjudged{0};

  // Late-watch -> events: why ticks were late; polled.
  rt::SpscQueue<LateTick, 1024> late_ticks;

  // Late-watch -> events: how often the wall clock was set, and by how much the last time, ns. Relaxed, they order nothing.
  std::atomic<std::uint64_t> clock_steps{0};
  std::atomic<std::int64_t> clock_step_ns{0};

  // Events -> subscriber: the owner of the tool runs on this host, and shares our wall clock. Flags; relaxed.
  std::array<std::atomic<bool>, kMaxTools> owner_is_here{};

  // Subscriber -> events, force-out -> events: how long a pose took to be handed over, and a force to be sent, ns. Polled; a
  // full ring loses the newest.
  rt::SpscQueue<std::int64_t, 2048> receive_delays;
  rt::SpscQueue<std::int64_t, 2048> force_delays;

  // Subscriber -> events: poses with a tool_id above 3, and the newest such id. Counters; relaxed, they order
  // nothing.
  std::atomic<std::uint64_t> unknown_poses{0};
  std::atomic<std::uint32_t> unknown_id{0};

  // Subscriber -> events: poses for another server, and the newest such server_id. Counters; relaxed, they order nothing.
  std::atomic<std::uint64_t> misaddressed_poses{0};
  std::atomic<std::uint32_t> misaddressed_id{0};

  // Parameter service's filter, on DDS's receive thread -> events: requests that were not looked at, because they were for
  // other servers or too many. Counters; relaxed, they order nothing.
  std::atomic<std::uint64_t> foreign_requests{0};
  std::atomic<std::uint64_t> surplus_requests{0};

  // Announcements' tap, on DDS's receive thread -> events: words of drivers for which there was no place. A counter; relaxed.
  std::atomic<std::uint64_t> surplus_announcements{0};

  // Tick -> recorder, only with --record: 16,384 ticks are 4 s at 4 kHz, longer than a disk stalls. On the heap, made before
  // the loop. Polled. A full ring loses the newest tick, which the counter says; relaxed, it orders nothing.
  std::unique_ptr<rt::SpscQueue<SessionTick, 16384>> recording;
  std::atomic<std::uint64_t> unrecorded{0};

  // Recorder -> events: the file cannot be written any more. A flag, relaxed.
  std::atomic<bool> recording_failed{false};

  // Events -> tick: another server answers the same poses. A flag, relaxed: it orders nothing.
  std::atomic<bool> rival{false};

  // Force-out and surface-out -> events. Counters; relaxed, they order nothing.
  std::atomic<std::uint64_t> failed_writes{0};

  // Main -> tick: send zero force; relaxed, it orders nothing. Tick -> force-out: all of it is in the ring; SYNC ZERO, release and
  // acquire. Force-out -> main: it was sent. Main -> events: whether it was, before `stopping`; relaxed.
  std::atomic<bool> shutting_down{false};
  std::atomic<bool> zero_force_made{false};
  rt::Semaphore zero_force_sent;
  std::atomic<bool> zero_force_out{true};

  // Force-out -> watchdog: how often it emptied the ring. Relaxed, it orders nothing.
  std::atomic<std::uint64_t> force_rounds{0};

  // Main -> force-out, surface-out, late-watch, events, once the tick has ended, or hangs: finish what is queued, and return.
  // SYNC STOP: stored with release before the thread's semaphore is posted, loaded with acquire after
  // waiting.
  std::atomic<bool> stopping{false};
  rt::Semaphore events_ready;
  rt::Semaphore late_watch_ready;
};

}  // namespace palpate::server
