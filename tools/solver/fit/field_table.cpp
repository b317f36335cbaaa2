// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/field_table.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include "core/record/crc32.h"

namespace palpate::solver {

namespace {

int openScratch(const ScratchPlace& place) {
  if (!place.name.empty())
    return open((place.folder / place.name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  std::string name = (place.folder / "palpate-fields-XXXXXX").string();
  const int file = mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) unlink(name.c_str());
  return file;
}

}  // namespace

FieldTable::FieldTable(const ScratchPlace& place, Blocks positions, std::size_t coefficients,
                       std::size_t rows)
    : file_(openScratch(place)), blocks_(std::move(positions)), coefficients_(coefficients), rows_(rows) {
  const std::size_t first = blocks_.ownBegin(), end = blocks_.ownEnd();
  for (std::size_t i = first; i < end; ++i) slot_[static_cast<std::size_t>(blocks_.order()[i])] = i - first;
  if (file_ < 0)
    throw std::runtime_error(place.folder.string() +
                             ": cannot make a scratch file there: " + std::strerror(errno));
  const std::size_t bytes = (end - first) * blockBytes();
  const int error = bytes > 0 ? posix_fallocate(file_, 0, static_cast<off_t>(bytes)) : 0;
  if (error != 0) {
    close(file_);
    throw std::runtime_error(place.folder.string() + ": no room for " + std::to_string(bytes) +
                             " bytes of scratch: " + std::strerror(error));
  }
}

FieldTable::~FieldTable() {
  close(file_);
}

void FieldTable::write(std::size_t position, std::span<const float> fields) {
  const char* data = reinterpret_cast<const char*>(fields.data());
  const std::size_t bytes = fields.size_bytes();
  const std::size_t begin = offsetOf(position);
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t n = pwrite(file_, data + done, bytes - done, static_cast<off_t>(begin + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw std::runtime_error(std::string("scratch file: write failed: ") + std::strerror(errno));
    done += static_cast<std::size_t>(n);
  }
}

void FieldTable::read(std::size_t position, std::span<float> fields) const {
  char* data = reinterpret_cast<char*>(fields.data());
  const std::size_t begin = offsetOf(position);
  std::size_t done = 0;
  while (done < blockBytes()) {
    const ssize_t n = pread(file_, data + done, blockBytes() - done, static_cast<off_t>(begin + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw std::runtime_error(std::string("scratch file: read failed: ") + std::strerror(errno));
    done += static_cast<std::size_t>(n);
  }
}

std::uint32_t FieldTable::checksum(std::span<const float> fields) noexcept {
  return record::crc32({reinterpret_cast<const std::uint8_t*>(fields.data()), fields.size_bytes()});
}

std::uint32_t FieldTable::checksum(std::size_t position, std::vector<float>& room) const {
  room.resize(coefficients_ * rows_);
  read(position, room);
  return checksum(room);
}

}  // namespace palpate::solver
