// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>

namespace palpate::proof {

/// A control group of the kernel (version 2, else 1) whose processes may hold few new pages. Removed at the end, which asks that all of
/// its processes have ended.
class MemoryGroup {
 public:
  /// @param[in] bytes  that it may hold, the files' pages in memory among them
  explicit MemoryGroup(std::size_t bytes);
  ~MemoryGroup();
  MemoryGroup(const MemoryGroup&) = delete;
  MemoryGroup& operator=(const MemoryGroup&) = delete;

  /// false: this machine lets nobody make one, or a group cannot bound memory
  [[nodiscard]] bool granted() const noexcept { return granted_; }
  /// What a process gets from now on counts here; what it has does not.
  [[nodiscard]] bool take(pid_t process) const;
  /// How often its bound was met.
  [[nodiscard]] long long timesFull() const;

 private:
  std::filesystem::path folder_;
  bool second_;  // version
  bool granted_{false};
};

/// A file whose content is on its disk, none of it in memory. Removed at the end.
class FileOnDisk {
 public:
  FileOnDisk(std::filesystem::path path, std::size_t bytes);
  ~FileOnDisk();
  FileOnDisk(const FileOnDisk&) = delete;
  FileOnDisk& operator=(const FileOnDisk&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

/// Reads a file again and again, from a process of its own that a group holds. Where the file is larger than the group's memory, that is
/// always full, and who wants a page there has to free one before.
class MemoryHog {
 public:
  MemoryHog(const MemoryGroup& group, const std::filesystem::path& file);
  ~MemoryHog();
  MemoryHog(const MemoryHog&) = delete;
  MemoryHog& operator=(const MemoryHog&) = delete;

 private:
  pid_t process_{-1};
};

}  // namespace palpate::proof
