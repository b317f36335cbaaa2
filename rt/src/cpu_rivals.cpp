// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/cpu_rivals.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

namespace palpate::rt {
namespace {

namespace fs = std::filesystem;

constexpr int kDeadlinePolicy = 6;  // SCHED_DEADLINE, which only the kernel's headers name

// Empty, or its beginning, where the process ends meanwhile: getline() catches what a stream's iterators throw then.
std::string contentOf(const fs::path& path) {
  std::ifstream file(path);
  std::string text;
  std::getline(file, text, '\0');
  return text;
}

// Folders of /proc whose names are numbers.
template <class Function>
void forEachNumber(const fs::path& folder, Function function) {
  std::error_code gone;  // a process may end while we walk
  for (fs::directory_iterator entry(folder, gone), end; !gone && entry != end; entry.increment(gone)) {
    const std::string name = entry->path().filename();
    int number = 0;
    const auto [rest, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc{} && rest == name.data() + name.size()) function(entry->path(), number);
  }
}

}  // namespace

std::string MachineThread::text() const {
  std::string said = name;
  said.append(" (").append(std::to_string(process));
  if (id != process) said.append("/").append(std::to_string(id));
  said.append(")");
  if (deadline) said.append(", DEADLINE");
  if (priority > 0) said.append(", FIFO ").append(std::to_string(priority));
  return said;
}

// proc(5): 1 is the number, 2 the name in brackets, which may hold blanks and brackets; 39 processor, 40 rt_priority, 41 policy.
std::optional<MachineThread> readStat(std::string_view line) {
  const std::size_t open = line.find('(');
  const std::size_t close = line.rfind(')');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return std::nullopt;
  MachineThread thread;
  thread.name = line.substr(open + 1, close - open - 1);
  std::istringstream fields{std::string(line.substr(close + 1))};
  std::string skipped;
  for (int field = 3; field < 39; ++field) fields >> skipped;
  int policy = 0;
  if (!(fields >> thread.cpu >> thread.priority >> policy)) return std::nullopt;
  thread.deadline = policy == kDeadlinePolicy;
  return thread;
}

// "cpuN user nice system idle iowait irq softirq steal guest guest_nice"
std::vector<std::int64_t> readSteal(std::string_view text) {
  std::vector<std::int64_t> stolen;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line) && line.rfind("cpu", 0) == 0;) {
    std::istringstream fields(line.substr(3));
    std::size_t cpu = 0;
    std::int64_t value = 0;
    if (line[3] == ' ' || !(fields >> cpu)) continue;
    for (int field = 0; field < 8; ++field) fields >> value;
    if (!fields) continue;
    stolen.resize(std::max(stolen.size(), cpu + 1));
    stolen[cpu] = value;
  }
  return stolen;
}

CpuRivals::CpuRivals(int thread, int priority, fs::path proc)
    : thread_(thread), priority_(priority), proc_(std::move(proc)) {}

void CpuRivals::look() {
  for (auto& [id, seen] : seen_) seen.now = false;
  forEachNumber(proc_, [this](const fs::path& process, int id) {
    forEachNumber(process / "task", [this, id](const fs::path& task, int) { lookAt(task, id); });
  });
  std::erase_if(seen_, [](const auto& entry) { return !entry.second.now; });
  first_ = false;
}

void CpuRivals::lookAt(const fs::path& task, int process) {
  std::optional<MachineThread> thread = readStat(contentOf(task / "stat"));
  if (!thread) return;
  thread->process = process;
  thread->id = std::atoi(task.filename().c_str());
  if (thread->id == thread_) return;
  const bool outranks = priority_ == 0 || thread->deadline || thread->priority >= priority_;
  const auto [entry, is_new] = seen_.try_emplace(thread->id);
  if (!outranks) {  // how much it ran is not read, but that it was there is known when it is raised
    entry->second = {*thread, 0, true, false};
    return;
  }
  thread->ran_ns = std::atoll(contentOf(task / "schedstat").c_str());
  // One that was not there at the look before ran since then, whatever it ran. Of one that has just been raised nobody knows.
  const std::int64_t before_ns = is_new && !first_        ? 0
                                 : entry->second.outranks ? entry->second.thread.ran_ns
                                                          : thread->ran_ns;
  entry->second = {*thread, thread->ran_ns - before_ns, true, true};
}

std::optional<MachineThread> CpuRivals::mostOn(std::span<const int> cpus, std::int64_t least_ns) const {
  const Seen* most = nullptr;
  for (const auto& [id, seen] : seen_) {
    if (std::find(cpus.begin(), cpus.end(), seen.thread.cpu) == cpus.end()) continue;
    if (seen.gained_ns >= least_ns && (most == nullptr || seen.gained_ns > most->gained_ns)) most = &seen;
  }
  return most == nullptr ? std::nullopt : std::optional(most->thread);
}

}  // namespace palpate::rt
