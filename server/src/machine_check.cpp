// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/machine_check.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "palpate/server/config.h"
#include "palpate/server/startup.h"
#include "tools/program/printed.h"

namespace palpate::server {
namespace {

namespace fs = std::filesystem;

constexpr int kIpcLock = 14, kSysNice = 23;  // capabilities: linux/capability.h

/// The first line of a file; nothing when it cannot be read.
std::optional<std::string> lineOf(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  if (!in) return std::nullopt;
  std::getline(in, line);
  return line;
}

std::optional<long long> numberOf(const fs::path& file) {
  const auto line = lineOf(file);
  long long number = 0;
  if (!line || std::from_chars(line->data(), line->data() + line->size(), number).ec != std::errc{})
    return std::nullopt;
  return number;
}

/// "0-3,6" has 2 and 6. What does not read has none.
bool hasCpu(std::string_view list, std::int64_t cpu) {
  while (!list.empty()) {
    const std::string_view part = list.substr(0, list.find(','));
    list.remove_prefix(std::min(list.size(), part.size() + 1));
    std::int64_t low = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), low);
    if (error != std::errc{}) continue;
    std::int64_t high = low;
    if (end != part.data() + part.size() && *end == '-')
      std::from_chars(end + 1, part.data() + part.size(), high);
    if (cpu >= low && cpu <= high) return true;
  }
  return false;
}

class Checker {
 public:
  Checker(fs::path root, std::int64_t tick_cpu) : root_(std::move(root)), tick_cpu_(tick_cpu) {}

  std::vector<MachineCheck> all() {
    return {kernel(),   isolated(),     interrupts(), throttling(),
            governor(), lockedMemory(), priority(),   sleepStates()};
  }

 private:
  static MachineCheck ok(MachineCheck check, std::string found) {
    check.suits = Suits::kOk;
    check.found = std::move(found);
    return check;
  }
  static MachineCheck better(MachineCheck check, std::string found, std::string remedy) {
    check.suits = Suits::kCouldBeBetter;
    check.found = std::move(found);
    check.remedy = std::move(remedy);
    return check;
  }
  static MachineCheck unknown(MachineCheck check, std::string found, std::string remedy = {}) {
    check.suits = Suits::kUnknown;
    check.found = std::move(found);
    check.remedy = std::move(remedy);
    return check;
  }

  [[nodiscard]] MachineCheck kernel() const {
    MachineCheck check{"kernel", "kernel", {}, {}, {}};
    const auto version = lineOf(root_ / "proc/version");
    if (lineOf(root_ / "sys/kernel/realtime") == "1" ||
        (version && version->find("PREEMPT_RT") != version->npos))
      return ok(check, "PREEMPT_RT");
    if (!version) return unknown(check, "/proc/version cannot be read");
    std::istringstream words(*version);
    std::string linux_word, word, release;
    words >> linux_word >> word >> release;  // "Linux version 6.1.0-18-amd64"
    return better(check, "no PREEMPT_RT: " + release,
                  "a kernel with PREEMPT_RT wakes threads on time under load (Debian: linux-image-rt-amd64)");
  }

  [[nodiscard]] MachineCheck isolated() const {
    MachineCheck check{"isolated_cpus", "isolated CPUs", {}, {}, {}};
    const auto list = lineOf(root_ / "sys/devices/system/cpu/isolated");
    if (!list) return unknown(check, "/sys/devices/system/cpu/isolated cannot be read");
    const std::string found = list->empty() ? "none" : *list;
    if (tick_cpu_ != kAnyCpu && hasCpu(*list, tick_cpu_)) return ok(check, found);
    const std::string cpu = tick_cpu_ == kAnyCpu ? "N" : std::to_string(tick_cpu_);
    if (tick_cpu_ == kAnyCpu && !list->empty())
      return better(check, found + ", and no --tick-cpu", "name one of them with --tick-cpu");
    return better(
        check, found,
        program::printed("boot with isolcpus=%s nohz_full=%s rcu_nocbs=%s, and --tick-cpu %s keeps the "
                         "tick there; or --tick-cpu-alone",
                         cpu.c_str(), cpu.c_str(), cpu.c_str(), cpu.c_str()));
  }

  /// Numbers of the interrupts that may come to the tick's CPU; nothing when there is no such folder.
  [[nodiscard]] std::optional<std::vector<int>> disturbing() const {
    std::error_code failure;
    fs::directory_iterator folders(root_ / "proc/irq", failure);
    if (failure) return std::nullopt;
    std::vector<int> numbers;
    for (const auto& folder : folders) {
      const std::string name = folder.path().filename().string();
      int number = 0;
      if (std::from_chars(name.data(), name.data() + name.size(), number).ec != std::errc{}) continue;
      auto cpus = lineOf(folder.path() / "effective_affinity_list");
      if (!cpus) cpus = lineOf(folder.path() / "smp_affinity_list");
      if (cpus && hasCpu(*cpus, tick_cpu_)) numbers.push_back(number);
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
  }

  [[nodiscard]] MachineCheck interrupts() const {
    MachineCheck check{"interrupts", "interrupts", {}, {}, {}};
    if (tick_cpu_ == kAnyCpu)
      return unknown(check, "no CPU is the tick's", "name one with --tick-cpu, and they are counted there");
    const auto numbers = disturbing();
    if (!numbers) return unknown(check, "/proc/irq cannot be read");
    const std::string cpu = "CPU " + std::to_string(tick_cpu_);
    if (numbers->empty()) return ok(check, "none comes to " + cpu);
    constexpr std::size_t kMost = 8;
    std::string list;
    for (std::size_t i = 0; i < std::min(numbers->size(), kMost); ++i)
      list += (i > 0 ? ", " : "") + std::to_string((*numbers)[i]);
    return better(check,
                  std::to_string(numbers->size()) + (numbers->size() == 1 ? " comes to " : " come to ") +
                      cpu + ": " + list + (numbers->size() > kMost ? ", ..." : ""),
                  "write other CPUs to /proc/irq/NUMBER/smp_affinity_list, or boot with irqaffinity=");
  }

  [[nodiscard]] MachineCheck throttling() const {
    MachineCheck check{"throttling", "real-time throttling", {}, {}, {}};
    const auto runtime = numberOf(root_ / "proc/sys/kernel/sched_rt_runtime_us");
    const auto period = numberOf(root_ / "proc/sys/kernel/sched_rt_period_us");
    if (!runtime || !period || *period <= 0)
      return unknown(check, "/proc/sys/kernel/sched_rt_* cannot be read");
    if (*runtime < 0) return ok(check, "off");
    const std::string found = program::printed("%lld of %lld us for real-time threads", *runtime, *period);
    if (2 * *runtime >= *period) return ok(check, found);
    return better(check, found, "sysctl kernel.sched_rt_runtime_us=950000");
  }

  [[nodiscard]] MachineCheck governor() const {
    MachineCheck check{"governor", "frequency governor", {}, {}, {}};
    const fs::path cpus = root_ / "sys/devices/system/cpu";
    std::error_code failure;
    std::string slow;
    std::size_t fast = 0;
    for (const auto& folder : fs::directory_iterator(cpus, failure)) {
      const std::string name = folder.path().filename().string();
      if (tick_cpu_ != kAnyCpu && name != "cpu" + std::to_string(tick_cpu_)) continue;
      const auto word = lineOf(folder.path() / "cpufreq/scaling_governor");
      if (!word) continue;
      if (*word == "performance")
        ++fast;
      else if (slow.empty() || name < slow.substr(0, slow.find(' ')))
        slow = name + " has " + *word;
    }
    if (!slow.empty()) return better(check, slow, "cpupower frequency-set --governor performance");
    if (fast > 0) return ok(check, "performance");
    return unknown(check, "none: the host or the firmware sets the frequency");
  }

  /// A capability of this process.
  [[nodiscard]] bool isCapable(int capability) const {
    std::ifstream in(root_ / "proc/self/status");
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with("CapEff:")) continue;
      return (std::strtoull(line.c_str() + 7, nullptr, 16) >> capability & 1U) != 0;
    }
    return false;
  }

  /// The soft limit behind a name, a number or "unlimited"; nothing when it is not there.
  [[nodiscard]] std::optional<std::string> limit(std::string_view name) const {
    std::ifstream in(root_ / "proc/self/limits");
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with(name)) continue;
      std::istringstream words(line.substr(name.size()));
      std::string soft;
      if (words >> soft) return soft;
    }
    return std::nullopt;
  }

  [[nodiscard]] MachineCheck lockedMemory() const {
    MachineCheck check{"memory_lock", "locked memory", {}, {}, {}};
    if (isCapable(kIpcLock)) return ok(check, "CAP_IPC_LOCK");
    const auto soft = limit("Max locked memory");
    if (!soft) return unknown(check, "/proc/self/limits cannot be read");
    if (*soft == "unlimited") return ok(check, *soft);
    return better(check, "at most " + *soft + " bytes", kMemoryRemedy);
  }

  [[nodiscard]] MachineCheck priority() const {
    MachineCheck check{"priority", "real-time priority", {}, {}, {}};
    if (isCapable(kSysNice)) return ok(check, "CAP_SYS_NICE");
    const auto soft = limit("Max realtime priority");
    if (!soft) return unknown(check, "/proc/self/limits cannot be read");
    const std::string found = "at most " + *soft + ", the tick wants " + std::to_string(kTickPriority);
    if (*soft == "unlimited" || std::atoi(soft->c_str()) >= kTickPriority) return ok(check, found);
    return better(check, found, kPriorityRemedy);
  }

  [[nodiscard]] MachineCheck sleepStates() const {
    MachineCheck check{"dma_latency", "sleep states", {}, {}, {}};
    const fs::path device = root_ / "dev/cpu_dma_latency";
    std::error_code failure;
    if (!fs::exists(device, failure)) return unknown(check, "there is no /dev/cpu_dma_latency");
    if (access(device.c_str(), W_OK) == 0) return ok(check, "/dev/cpu_dma_latency can be held at 0 us");
    return better(check, "/dev/cpu_dma_latency cannot be written", kAwakeRemedy);
  }

  fs::path root_;
  std::int64_t tick_cpu_;
};

}  // namespace

std::vector<MachineCheck> checkMachine(const fs::path& root, std::int64_t tick_cpu) {
  return Checker(root, tick_cpu).all();
}

bool grantsRealtime(const std::vector<MachineCheck>& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const MachineCheck& check) {
    return check.suits == Suits::kOk || check.key != "priority";
  });
}

const char* wordOf(Suits suits) noexcept {
  return suits == Suits::kOk ? "ok" : suits == Suits::kCouldBeBetter ? "could be better" : "unknown";
}

std::string textOf(const std::vector<MachineCheck>& checks) {
  std::string text;
  for (const MachineCheck& check : checks) {
    text += program::printed("%-21s %-16s ", check.name.c_str(), wordOf(check.suits)) + check.found + '\n';
    if (!check.remedy.empty()) text += std::string(39, ' ') + check.remedy + '\n';
  }
  return text;
}

}  // namespace palpate::server
