// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::rt {

/// A thread of the machine, as /proc/PID/task/TID/stat says it.
struct MachineThread {
  int process{0};
  int id{0};
  std::string name;
  int cpu{0};              ///< where it ran last
  int priority{0};         ///< SCHED_FIFO or SCHED_RR, 1 to 99; 0: none
  bool deadline{false};    ///< SCHED_DEADLINE
  std::int64_t ran_ns{0};  ///< so far

  /// "stress-ng (4711), FIFO 90"; a thread that is not its process's first by its own number too: "hog (4711/4713)"
  [[nodiscard]] std::string text() const;
};

/// @param[in] line  of /proc/PID/task/TID/stat
/// @return name, processor and priority; nothing where the line is not one
[[nodiscard]] std::optional<MachineThread> readStat(std::string_view line);

/// What the host stole from each processor, in the kernel's units. @param[in] text  of /proc/stat
[[nodiscard]] std::vector<std::int64_t> readSteal(std::string_view text);

/// Which threads of the machine may keep a thread of ours from its processor, and how much they ran.
/// Threads: one. Real-time: no: a look reads a file or two for each thread of the machine, some milliseconds.
class CpuRivals {
 public:
  /// @param[in] thread    ours, which is no rival of its own
  /// @param[in] priority  its SCHED_FIFO priority; 0: an ordinary thread, whose rivals are all others
  CpuRivals(int thread, int priority, std::filesystem::path proc = "/proc");

  /// Looks at all threads; what they ran since the look before is what mostOn() compares.
  void look();

  /// @return the rival that ran longest on one of these processors between the last two looks, if that was at least `least_ns`
  [[nodiscard]] std::optional<MachineThread> mostOn(std::span<const int> cpus, std::int64_t least_ns) const;

 private:
  void lookAt(const std::filesystem::path& task, int process);

  struct Seen {
    MachineThread thread;
    std::int64_t gained_ns{0};
    bool now{false};       // in the newest look
    bool outranks{false};  // then; else its ran_ns is not read
  };
  int thread_;
  int priority_;
  std::filesystem::path proc_;
  std::map<int, Seen> seen_;
  bool first_{true};
};

}  // namespace palpate::rt
