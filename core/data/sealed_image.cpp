// SPDX-License-Identifier: Apache-2.0
#include "core/data/sealed_image.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "core/data/available_memory.h"
#include "core/data/descriptor.h"
#include "core/data/load_error.h"

namespace palpate {

namespace {

constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw LoadError(path.string() + ": " + what);
}

[[noreturn]] void failSystem(const std::filesystem::path& path, const std::string& what) {
  fail(path, what + ": " + std::strerror(errno));
}

std::size_t regularFileSize(const std::filesystem::path& path, int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) failSystem(path, "cannot be examined");
  if (!S_ISREG(status.st_mode)) fail(path, "is no regular file, expected a model file");
  if (status.st_size == 0) fail(path, "is empty, expected a model file");
  return static_cast<std::size_t>(status.st_size);
}

}  // namespace

SealedImage::SealedImage(const std::filesystem::path& path) {
  const Descriptor source(
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // a pipe must not block us
  if (source.get() < 0) failSystem(path, "cannot be opened");
  makeFrom(source.get(), path);
}

SealedImage::SealedImage(int descriptor, const std::filesystem::path& name) {
  makeFrom(descriptor, name);
}

void SealedImage::makeFrom(int source, const std::filesystem::path& name) {
  try {
    copyFrom(source, name);
    seal(name);
    map(name);
  } catch (...) {
    release();
    throw;
  }
}

SealedImage::SealedImage(SealedImage&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      locked_(other.locked_) {}

SealedImage& SealedImage::operator=(SealedImage&& other) noexcept {
  if (this == &other) return *this;
  release();
  descriptor_ = std::exchange(other.descriptor_, -1);
  data_ = std::exchange(other.data_, nullptr);
  size_ = std::exchange(other.size_, 0);
  locked_ = other.locked_;
  return *this;
}

SealedImage::~SealedImage() {
  release();
}

void SealedImage::copyFrom(int source, const std::filesystem::path& path) {
  size_ = regularFileSize(path, source);
  requireMemoryFile(path, "its copy", size_);
  descriptor_ = ::memfd_create("palpate-model", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (descriptor_ < 0) failSystem(path, "no memory file can be created for its copy");
  std::vector<std::byte> chunk(std::size_t{1} << 20U);
  std::size_t copied = 0;
  for (;;) {
    const ssize_t got = ::read(source, chunk.data(), chunk.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) failSystem(path, "cannot be read");
    if (got == 0) break;
    copied += static_cast<std::size_t>(got);
    if (copied > size_) break;  // it may grow for ever
    writeCopy(path, std::span(chunk).first(static_cast<std::size_t>(got)));
  }
  if (copied != size_)
    fail(path, "gave " + std::string(copied > size_ ? "more than " : "") +
                   std::to_string(std::min(copied, size_)) + " bytes, expected " + std::to_string(size_) +
                   ": it changed while it was read");
}

void SealedImage::writeCopy(const std::filesystem::path& path, std::span<const std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t put = ::write(descriptor_, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) failSystem(path, "cannot be copied into memory");
    bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
}

void SealedImage::seal(const std::filesystem::path& path) const {
  // Linux says EBUSY while it holds some of the pages itself, as when it moves them; it has then waited 0.15 s for them.
  constexpr int kAttempts = 20;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (::fcntl(descriptor_, F_ADD_SEALS, kSeals) == 0) return;
    if (errno != EBUSY && errno != EINTR) break;
  }
  failSystem(path, "its copy in memory cannot be sealed");
}

void SealedImage::map(const std::filesystem::path& path) {
  // MAP_PRIVATE: kernels before 6.7 refuse a shared mapping of a write-sealed file, and unwritten pages are
  // shared anyway.
  void* const start = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor_, 0);
  if (start == MAP_FAILED) failSystem(path, "its copy cannot be mapped");
  data_ = static_cast<const std::byte*>(start);
  locked_ = ::mlock(data_, size_) == 0;
}

void SealedImage::release() noexcept {
  if (data_ != nullptr) ::munmap(const_cast<std::byte*>(data_), size_);
  if (descriptor_ >= 0) ::close(descriptor_);
  data_ = nullptr;
  descriptor_ = -1;
}

}  // namespace palpate
