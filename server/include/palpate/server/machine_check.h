// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpate::server {

/// How one setting of the machine suits a tick.
enum class Suits { kOk, kCouldBeBetter, kUnknown };

/// One setting, and what to do about it.
struct MachineCheck {
  std::string key;   ///< "kernel", "isolated_cpus", ...
  std::string name;  ///< for people
  Suits suits{Suits::kUnknown};
  std::string found;   ///< what there is
  std::string remedy;  ///< one line; empty where it is ok
};

/// Looks at what decides how punctually a tick can be: the kernel's preemption, isolated CPUs, interrupts, throttling of
/// real-time threads, frequency governor, this process's limits of locked memory and priority, sleep states.
/// @param[in] root  the folder that holds proc, sys and dev: "/"
/// @param[in] tick_cpu  kAnyCpu: none was named
/// Real-time: no.
[[nodiscard]] std::vector<MachineCheck> checkMachine(const std::filesystem::path& root,
                                                     std::int64_t tick_cpu);

/// Whether a server with --realtime require would get its priorities: nothing else is required, and what cannot be read does
/// not say so. Memory that is not locked is advice, as at the server's start.
[[nodiscard]] bool grantsRealtime(const std::vector<MachineCheck>& checks);

/// "ok", "could be better", "unknown"
[[nodiscard]] const char* wordOf(Suits suits) noexcept;

/// A line for each, and one more with its remedy.
[[nodiscard]] std::string textOf(const std::vector<MachineCheck>& checks);

}  // namespace palpate::server
