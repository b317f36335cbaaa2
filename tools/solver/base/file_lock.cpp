// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

namespace palpate::solver {

namespace {

/// Whether a name still leads to an open file: who has a file locked may remove it.
bool leadsTo(const std::filesystem::path& name, int file) {
  struct stat of_name {
  }, of_file{};
  return stat(name.c_str(), &of_name) == 0 && fstat(file, &of_file) == 0 &&
         of_name.st_ino == of_file.st_ino && of_name.st_dev == of_file.st_dev;
}

}  // namespace

std::optional<FileLock> FileLock::take(const std::filesystem::path& file,
                                       std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds kLook{100};
  for (auto left = patience;; left -= kLook) {
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor < 0 && errno == ENOENT) return std::nullopt;
    if (descriptor < 0)
      throw std::runtime_error(file.string() + ": cannot be opened: " + std::strerror(errno));
    FileLock lock(descriptor);
    const int failed = flock(descriptor, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    if (failed == 0 && leadsTo(file, descriptor)) return lock;
    if (failed != 0 && failed != EWOULDBLOCK && failed != EINTR)
      throw std::runtime_error(file.string() + ": cannot be locked: " + std::strerror(failed));
    if (left <= std::chrono::milliseconds(0)) return std::nullopt;
    if (failed != 0) std::this_thread::sleep_for(kLook);
  }
}

FileLock::FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock::~FileLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace palpate::solver
