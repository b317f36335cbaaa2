// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

namespace palpate::solver {

/// A file that one program at a time has, also one of another machine where the file system's locks reach so far. The kernel takes it
/// back from a program that ends, however it does.
class FileLock {
 public:
  /// Makes the file where it is absent.
  /// @param patience  for another program that has it: one that was killed has it until the kernel has taken its memory back
  /// @return none: another program has it, or the file's folder is gone  @throw std::runtime_error  naming the file
  [[nodiscard]] static std::optional<FileLock> take(const std::filesystem::path& file,
                                                    std::chrono::milliseconds patience = kPatience);
  static constexpr std::chrono::milliseconds kPatience{2000};

  FileLock(FileLock&& other) noexcept;
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  explicit FileLock(int descriptor) noexcept : descriptor_(descriptor) {}
  int descriptor_;  ///< -1: moved from
};

}  // namespace palpate::solver
