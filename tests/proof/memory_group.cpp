// SPDX-License-Identifier: Apache-2.0
#include "memory_group.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace palpate::proof {
namespace {

const std::filesystem::path kGroups = "/sys/fs/cgroup";

std::string textOf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text << std::flush;
  return static_cast<bool>(stream);
}

}  // namespace

MemoryGroup::MemoryGroup(std::size_t bytes) {
  second_ = textOf(kGroups / "cgroup.subtree_control").find("memory") != std::string::npos;
  folder_ = (second_ ? kGroups : kGroups / "memory") / ("palpate-late-" + std::to_string(getpid()));
  std::error_code refused;
  granted_ = std::filesystem::create_directory(folder_, refused) &&
             write(folder_ / (second_ ? "memory.max" : "memory.limit_in_bytes"), std::to_string(bytes));
}

MemoryGroup::~MemoryGroup() {
  for (int i = 0; i < 100 && rmdir(folder_.c_str()) != 0; ++i)  // a process that has just ended
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

bool MemoryGroup::take(pid_t process) const {
  return write(folder_ / "cgroup.procs", std::to_string(process));
}

long long MemoryGroup::timesFull() const {
  const std::string text = textOf(folder_ / (second_ ? "memory.events" : "memory.failcnt"));
  const std::size_t at = second_ ? text.find("\nmax ") + 5 : 0;
  return std::atoll(text.substr(at).c_str());
}

FileOnDisk::FileOnDisk(std::filesystem::path path, std::size_t bytes) : path_(std::move(path)) {
  std::ofstream stream(path_);
  const std::vector<char> part(std::size_t{1} << 20, 'x');
  for (std::size_t written = 0; written < bytes; written += part.size())
    stream.write(part.data(), static_cast<std::streamsize>(part.size()));
  stream.close();
  const int file = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  fsync(file);
  (void)posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
  close(file);
}

FileOnDisk::~FileOnDisk() {
  std::error_code gone;
  std::filesystem::remove(path_, gone);
}

MemoryHog::MemoryHog(const MemoryGroup& group, const std::filesystem::path& file) {
  const int opened = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  std::array<int, 2> ready{};
  if (opened < 0 || pipe(ready.data()) != 0) return;
  process_ = fork();
  if (process_ == 0) {  // only what may be called between fork() and exec()
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    close(ready[1]);  // so that read() ends where the parent has ended before that
    static std::array<char, 65536> buffer;
    char begin = 0;
    if (read(ready[0], &begin, 1) != 1) _exit(1);
    while (lseek(opened, 0, SEEK_SET) == 0)
      while (read(opened, buffer.data(), buffer.size()) > 0) {
      }
    _exit(1);
  }
  (void)group.take(process_);
  (void)!::write(ready[1], "x", 1);
  for (const int end : {ready[0], ready[1], opened}) close(end);
}

MemoryHog::~MemoryHog() {
  if (process_ <= 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

}  // namespace palpate::proof
