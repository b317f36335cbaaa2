// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <tuple>

#include "core/tick/step.h"
#include "palpate/rt/periodic_thread.h"
#include "palpate/rt/phase_lock.h"
#include "palpate/server/channels.h"
#include "palpate/server/engine.h"
#include "palpate/server/field_pace.h"

namespace palpate::server {

/// Periods of the loop and of the surface.
struct TickPlan {
  std::int64_t period_ns{1'000'000};  ///< of the loop
  std::int64_t surface_period_ns{
      0};                  ///< from one surface field to the next; up to period_ns: with every tick
  bool phase_lock{false};  ///< ticks follow the poses' arrival
};

/// One tick: newest poses in, one step of the engine, forces and what the surface is made of out (docs/design.md, Contact, Threads).
/// Takes no lock, allocates nothing, logs nothing, knows no DDS. What it keeps from tick to tick is
/// bookkeeping only; the state of the contact lives in the engine's Workspace. Another engine (Channels::next_engine) is taken
/// once all forces of this one have gone to zero. Threads: one, the tick thread.
/// Real-time: yes.
class Tick {
 public:
  /// Engines must outlive their use, `channels` the tick.
  Tick(Engine& first, Channels& channels, const TickPlan& plan)
      : engine_(&first), channels_(channels), plan_(plan) {
    phases_.fill(rt::PhaseLock(plan.period_ns));
    input_.period_ns = plan.period_ns;
  }

  /// @return shift of the ticks' grid, ns
  [[nodiscard]] std::int64_t run(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;

  /// run() for a PeriodicThread; context is the Tick.
  static std::int64_t onCycle(void* context, const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING {
    return static_cast<Tick*>(context)->run(cycle);
  }

  /// For a PeriodicThread's Rehearsal; context is the Tick. Takes the last tick's step once more, on a workspace of its own: code and
  /// model are in the caches when the poses are read (docs/decisions/rehearsal.md).
  static void onRehearsal(void* context) noexcept PALPATE_NONBLOCKING;

  /// For a PeriodicThread's LateListener; context is the Channels.
  static void onLate(void* channels, const rt::LateCycle& cycle) noexcept PALPATE_NONBLOCKING;

 private:
  // What the tick counts and keeps for one tool.
  struct Ledger {
    PoseSample pose;              // newest that a tick knew
    std::uint64_t force_seq{0};   // forces sent
    std::uint64_t superseded{0};  // poses that no tick ever knew
    std::uint64_t came{0};        // poses since the last tick
    bool changed_hands{
        false};  // since the last tick, at once: another publisher's, and the former one is gone
  };

  void changeEngine(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;
  void readPoses(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;
  void readPose(std::size_t tool, std::int64_t now_ns) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] std::uint32_t noticed(const PoseSample& pose, std::uint64_t unordered_before,
                                      std::int64_t now_ns) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool rejected(std::size_t tool) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] std::uint32_t told(std::size_t tool) const noexcept PALPATE_NONBLOCKING;
  void countRejectedPoses() noexcept PALPATE_NONBLOCKING;
  void writeForces(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;
  void answerStranger(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;
  void push(ForceRecord& record, const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;
  void writeRecording(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool surfaceIsDue(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;
  void writeSurface(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;
  void followPoses(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;
  void reportTick(const rt::Cycle& cycle) noexcept PALPATE_NONBLOCKING;
  void reportZeroForce() noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool allForcesAreZero() const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool seen(std::size_t tool) const noexcept PALPATE_NONBLOCKING {
    return ledgers_[tool].pose.received > 0;
  }

  Engine* engine_;
  Engine* next_engine_{nullptr};   // to be taken, once all forces are zero
  std::uint64_t engine_began_{0};  // ticks run before this engine's first one
  Channels& channels_;
  TickPlan plan_;

  StepInput input_;
  StepResult result_, rehearsed_;
  bool unrehearsed_settings_{false};  // came in a tick that was not rehearsed since
  std::array<Ledger, kMaxTools> ledgers_{};
  Strangers strangers_{};
  std::array<std::uint64_t, std::tuple_size_v<Strangers>> stranger_seq_{};  // forces sent to each
  std::size_t next_stranger_{0};
  std::int64_t last_woke_ns_{0};
  std::uint64_t last_overruns_{0};
  bool overrun_{false};                          // ticks were missed before this one
  std::array<rt::PhaseLock, kMaxTools> phases_;  // one per tool, so that no tool resets another's
  std::size_t followed_{0};                      // the tool whose poses set the phase
  std::int64_t shift_ns_{0};
  std::uint64_t surface_seq_{0};
  std::int64_t next_surface_ns_{0};
  SurfaceState handed_over_;
  std::uint64_t shown_engine_{0};  // whose it was
  FieldPace field_pace_;
  std::uint64_t rejected_{0};
  std::uint64_t dropped_{0};
  bool all_in_ring_{true};  // the forces of this tick
  int zero_ticks_{0};       // in a row, while shutting down
};

}  // namespace palpate::server
