// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "palpate/client/gap_counter.h"
#include "palpate/idl/types.h"
#include "palpate/rt/cycle_stats.h"

namespace palpate::latency {

/// Times in the answers of a server.
/// Threads: add() on the receive thread, record() on any; the rest before receiving starts or after it ends.
class LatencyLog {
 public:
  /// @param[in] period_ns  of the poses; an answer to a pose older than two periods is late
  explicit LatencyLog(std::int64_t period_ns) noexcept : period_ns_(period_ns) {}

  /// Starts and ends the measurement; answers before and after do not count. Threads: any.
  void record(bool on) noexcept { recording_.store(on, std::memory_order_relaxed); }

  /// @param[in] received_ns  on the clock that stamped the poses
  /// Real-time: yes.
  void add(const dds::ToolForce& force, std::int64_t received_ns) noexcept;

  /// @param[in] tool  whose poses are measured  @param[in] received_ns  as for a force. Threads: one, fields'. Real-time: yes.
  void addField(const dds::SurfaceDisplacement& field, std::uint32_t tool, std::int64_t received_ns) noexcept;

  /// After the last answer: poses that had waited for more than two periods when the measurement ended count by how long.
  /// @param[in] end_ns  of the measurement, on the clock that stamped the poses
  void finish(std::int64_t end_ns) noexcept;

  /// From each pose to the first force that answers it or a newer one, corrected for coordinated omission: poses that were
  /// superseded, lost, or not sent since the sender itself slept count at the times of their grid, so that a stall of five
  /// periods shows as five values and not as one. After G. Tene's HdrHistogram; he infers the omitted values from the
  /// largest, here the stamps of the poses tell them.
  [[nodiscard]] const rt::CycleStats& poseToForce() const noexcept { return pose_to_force_; }
  /// The same of the poses that a force names, without that correction.
  [[nodiscard]] const rt::CycleStats& answeredPoseToForce() const noexcept { return answered_; }
  /// From a pose's arrival at the server to the planned time of the tick that answered it, by the server's clock.
  [[nodiscard]] const rt::CycleStats& wait() const noexcept { return wait_; }
  /// answeredPoseToForce() less that wait, pose by pose: the cost of wire, wake-up, tick and threads.
  [[nodiscard]] const rt::CycleStats& poseToForceLessWait() const noexcept { return less_wait_; }
  /// Pose to the first field that names it; no count where none were read.
  [[nodiscard]] const rt::CycleStats& poseToField() const noexcept { return pose_to_field_; }
  [[nodiscard]] const rt::CycleStats& wakeup() const noexcept { return wakeup_; }
  [[nodiscard]] const rt::CycleStats& tick() const noexcept { return tick_; }
  [[nodiscard]] std::uint64_t received() const noexcept { return answers_.received(); }
  [[nodiscard]] std::uint64_t lost() const noexcept { return answers_.lost(); }
  [[nodiscard]] std::uint64_t restarts() const noexcept { return answers_.restarts(); }
  [[nodiscard]] std::uint64_t late() const noexcept { return late_; }
  /// When the newest answer came, measured or not; 0: none did.
  [[nodiscard]] std::int64_t newestAnswerNs() const noexcept { return newest_answer_ns_; }
  /// The server's counts during the measurement.
  [[nodiscard]] std::uint64_t overruns() const noexcept { return last_.overruns - first_.overruns; }
  [[nodiscard]] std::uint64_t superseded() const noexcept { return last_.superseded - first_.superseded; }

 private:
  void addOnGrid(std::int64_t least_ns, std::int64_t poses) noexcept;

  struct ServerCounters {
    std::uint64_t overruns{0};
    std::uint64_t superseded{0};
  };

  std::int64_t period_ns_;
  std::atomic<bool> recording_{false};  // orders nothing else
  rt::CycleStats pose_to_force_;
  rt::CycleStats answered_;
  rt::CycleStats wait_;
  rt::CycleStats less_wait_;
  rt::CycleStats wakeup_;
  rt::CycleStats tick_;
  client::GapCounter answers_;
  std::uint64_t newest_pose_{0};
  std::int64_t newest_answer_ns_{0};
  std::int64_t answered_stamp_ns_{0};   // of the newest pose with an answer, in the measurement; 0: none yet
  rt::CycleStats pose_to_field_;        // addField()'s,
  std::uint64_t newest_field_pose_{0};  // and this
  std::uint64_t late_{0};
  ServerCounters first_;
  ServerCounters last_;
};

}  // namespace palpate::latency
