// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/record/crc32.h"
#include "tools/solver/base/parallel.h"

namespace palpate::solver {

namespace {

/// Before what is kept of a part. `checksum` is of the other members and of what follows.
struct Head {
  std::uint64_t part{0}, size{0};
  double seconds{0.0};
  std::uint32_t checksum{0}, unused{0};
};

std::uint32_t checksumOf(Head head, std::span<const std::uint8_t> result) {
  head.checksum = 0;
  record::Bytes first;
  record::put(first, head);
  return record::crc32(result, record::crc32(first));
}

/// @return false where the file ends, with errno 0, or cannot be read
bool readWhole(int file, void* to, std::size_t size, std::int64_t offset) {
  errno = 0;
  for (std::size_t done = 0; done < size;) {
    const ssize_t n =
        pread(file, static_cast<char*>(to) + done, size - done, offset + static_cast<off_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

Journal::Journal(std::filesystem::path file) : path_(std::move(file)) {
  file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0) fail("cannot open");
  readBack();
}

Journal::~Journal() {
  close(file_);
}

void Journal::fail(const char* what) const {
  throw std::runtime_error(path_.string() + ": " + what + ": " + std::strerror(errno));
}

/// Finds the parts, and cuts off what was not appended whole.
void Journal::readBack() {
  const off_t end = lseek(file_, 0, SEEK_END);
  std::int64_t offset = 0;
  Head head;
  record::Bytes result;
  while (readWhole(file_, &head, sizeof head, offset)) {
    const std::int64_t begin = offset + static_cast<std::int64_t>(sizeof head);
    if (head.size > static_cast<std::uint64_t>(end - begin)) break;
    result.resize(head.size);
    if (!readWhole(file_, result.data(), result.size(), begin) || checksumOf(head, result) != head.checksum)
      break;  // errno says whether it could be read
    places_[head.part] = {begin, result.size(), head.seconds};
    offset = begin + static_cast<std::int64_t>(head.size);
  }
  if (errno != 0) fail("cannot be read");  // what is behind is not damaged
  if (offset < end && ftruncate(file_, offset) != 0) fail("cannot cut off what is damaged");
  if (lseek(file_, offset, SEEK_SET) != offset) fail("cannot be read");
}

std::optional<record::Bytes> Journal::find(std::uint64_t part) const {
  const std::lock_guard lock(mutex_);
  const auto place = places_.find(part);
  if (place == places_.end()) return std::nullopt;
  record::Bytes result(place->second.size);
  if (!readWhole(file_, result.data(), result.size(), place->second.offset)) return std::nullopt;
  return result;
}

void Journal::taken(std::uint64_t part) const {
  const std::lock_guard lock(mutex_);
  found_ += places_.at(part).seconds;
}

void Journal::keep(std::uint64_t part, const record::Bytes& result, double seconds) {
  Head head{part, result.size(), seconds};
  head.checksum = checksumOf(head, result);
  record::Bytes all;
  record::put(all, head);
  record::putBytes(all, result.data(), result.size());
  const std::lock_guard lock(mutex_);
  for (std::size_t done = 0; done < all.size();) {
    const ssize_t n = write(file_, all.data() + done, all.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("cannot be written");
    done += static_cast<std::size_t>(n);
  }
}

double Journal::found() const {
  const std::lock_guard lock(mutex_);
  return found_;
}

void parallelParts(int workers, PartRange parts, Journal* journal,
                   const std::function<void(std::size_t, record::ByteSource&)>& restore,
                   const std::function<record::Bytes(int, std::size_t)>& work) {
  const std::size_t count = parts.end - parts.begin;
  std::vector<std::uint8_t> done(count, 0);
  if (journal != nullptr)
    parallelFor(workers, count, [&](int, std::size_t i) {
      const std::size_t part = parts.begin + i;
      const std::optional<record::Bytes> kept = journal->find(part);
      if (!kept) return;
      try {
        record::ByteSource source(*kept);
        restore(part, source);
        journal->taken(part);
        done[i] = 1;
      } catch (const record::RecordError&) {  // what its record stands for is not what it was
      }
    });
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < count; ++i)
    if (done[i] == 0) left.push_back(parts.begin + i);
  parallelFor(workers, left.size(), [&](int worker, std::size_t i) {
    const auto start = std::chrono::steady_clock::now();
    const record::Bytes result = work(worker, left[i]);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (journal != nullptr) journal->keep(left[i], result, took.count() / workers);
  });
}

}  // namespace palpate::solver
