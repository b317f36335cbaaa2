// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace palpate {

/// A copy of a file in anonymous memory that cannot be written, grown or shrunk, mapped read-only.
/// Nothing can change between a check and a use, and truncating the file cannot kill the reader with SIGBUS
/// docs/model_file.md
class SealedImage {
 public:
  /// @throw LoadError when the file is not a regular file, is empty, changes while it is read, or memory is short
  explicit SealedImage(const std::filesystem::path& path);
  /// The same of a file that is open for reading. @param descriptor  borrowed  @param name  how it is called in messages
  SealedImage(int descriptor, const std::filesystem::path& name);
  SealedImage(SealedImage&& other) noexcept;
  SealedImage& operator=(SealedImage&& other) noexcept;
  SealedImage(const SealedImage&) = delete;
  SealedImage& operator=(const SealedImage&) = delete;
  ~SealedImage();

  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return {data_, size_}; }
  /// Open file descriptor of the copy, owned by this object.
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  [[nodiscard]] bool locked() const noexcept { return locked_; }

 private:
  void makeFrom(int source, const std::filesystem::path& name);
  void copyFrom(int source, const std::filesystem::path& path);
  void writeCopy(const std::filesystem::path& path, std::span<const std::byte> bytes) const;
  void seal(const std::filesystem::path& path) const;
  void map(const std::filesystem::path& path);
  void release() noexcept;

  int descriptor_{-1};
  const std::byte* data_{nullptr};
  std::size_t size_{0};
  bool locked_{false};
};

}  // namespace palpate
