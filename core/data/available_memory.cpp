// SPDX-License-Identifier: Apache-2.0
#include "core/data/available_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>

#include "core/data/load_error.h"

namespace palpate {

namespace {

using std::filesystem::path;

/// What the files of a control group's memory are called.
struct GroupFiles {
  const char* limit;
  const char* used;
  const char* prefix;  ///< of the lines of memory.stat that count children too
};
constexpr GroupFiles kVersion1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_"};
constexpr GroupFiles kVersion2{"memory.max", "memory.current", ""};

/// The first number of a file; none where there is no such file, or it says "max".
std::optional<std::uint64_t> numberIn(const path& file) {
  std::uint64_t number = 0;
  std::ifstream in(file);
  return in >> number ? std::optional(number) : std::nullopt;
}

/// The number behind a word that begins a line; 0 without one.
std::uint64_t numberAfter(const path& file, const std::string& word) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string first;
    std::uint64_t number = 0;
    if (words >> first >> number && first == word) return number;
  }
  return 0;
}

void lower(AvailableMemory& least, std::uint64_t bytes, const char* limit) {
  if (bytes < least.bytes) least = {bytes, limit};
}

void lowerToGroup(AvailableMemory& least, const path& group, const GroupFiles& files) {
  const auto limit = numberIn(group / files.limit), used = numberIn(group / files.used);
  if (!limit || !used) return;
  std::uint64_t droppable = 0;
  for (const char* pages : {"inactive_file", "active_file"})
    droppable += numberAfter(group / "memory.stat", files.prefix + std::string(pages));
  const std::uint64_t kept = *used - std::min(*used, droppable);
  lower(least, *limit - std::min(*limit, kept), "its control group");
}

/// A line of /proc/self/cgroup: NUMBER:CONTROLLERS:/PATH. The group and all above it; a container sees its own as "/".
void lowerToGroups(AvailableMemory& least, const path& root, const std::string& line) {
  const std::size_t first = line.find(':'), second = line.find(':', first + 1);
  if (second == std::string::npos) return;
  const std::string controllers = line.substr(first + 1, second - first - 1);
  if (!controllers.empty() && controllers != "memory") return;
  const GroupFiles& files = controllers.empty() ? kVersion2 : kVersion1;
  const path mount = root / "sys/fs/cgroup" / (controllers.empty() ? "" : "memory");
  for (path group = path(line.substr(second + 1)).relative_path();; group = group.parent_path()) {
    lowerToGroup(least, mount / group, files);
    if (group.empty()) return;
  }
}

void lowerToFileSize(AvailableMemory& least) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    lower(least, limit.rlim_cur, "ulimit -f");
}

void lowerToAddresses(AvailableMemory& least) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  lower(least, limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, addressSpace()), "ulimit -v");
}

void require(const path& file, const std::string& what, std::uint64_t bytes,
             const AvailableMemory& available) {
  const auto inMiB = [](std::uint64_t number) { return std::to_string(number >> 20U) + " MiB"; };
  if (bytes <= available.bytes) return;
  throw LoadError(file.string() + ": " + what + " needs " + inMiB(bytes + (1U << 20U) - 1) + " of memory, " +
                  inMiB(available.bytes) + " are available (" + available.limit + ")");
}

}  // namespace

std::uint64_t addressSpace() {
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return page * numberIn("/proc/self/statm").value_or(0);
}

AvailableMemory availableMemory(const path& root) {
  AvailableMemory least{UINT64_MAX, ""};
  if (const std::uint64_t kib = numberAfter(root / "proc/meminfo", "MemAvailable:"); kib > 0)
    lower(least, kib << 10U, "the machine");
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) lowerToGroups(least, root, line);
  lowerToAddresses(least);
  return least;
}

void requireMemory(const path& file, const std::string& what, std::uint64_t bytes) {
  require(file, what, bytes, availableMemory());
}

void requireMemoryFile(const path& file, const std::string& what, std::uint64_t bytes) {
  AvailableMemory available = availableMemory();
  lowerToFileSize(available);
  require(file, what, bytes, available);
}

}  // namespace palpate
