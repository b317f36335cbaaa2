// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/field_table.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace palpate::solver {

FieldTable::FieldTable(const std::filesystem::path& folder, std::size_t positions, std::size_t coefficients,
                       std::size_t rows)
    : positions_(positions), coefficients_(coefficients), rows_(rows) {
  std::string name = (folder / "palpate-fields-XXXXXX").string();
  file_ = mkostemp(name.data(), O_CLOEXEC);
  if (file_ < 0)
    throw std::runtime_error(folder.string() + ": cannot make a scratch file there: " + std::strerror(errno));
  unlink(name.c_str());
  const std::size_t bytes = positions * blockBytes();
  const int error = bytes > 0 ? posix_fallocate(file_, 0, static_cast<off_t>(bytes)) : 0;
  if (error != 0) {
    close(file_);
    throw std::runtime_error(folder.string() + ": no room for " + std::to_string(bytes) +
                             " bytes of scratch: " + std::strerror(error));
  }
}

FieldTable::~FieldTable() {
  close(file_);
}

void FieldTable::write(std::size_t position, std::span<const float> fields) {
  const char* data = reinterpret_cast<const char*>(fields.data());
  const std::size_t bytes = fields.size_bytes();
  const std::size_t begin = position * blockBytes();
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
  std::size_t done = 0;
  while (done < blockBytes()) {
    const ssize_t n =
        pread(file_, data + done, blockBytes() - done, static_cast<off_t>(position * blockBytes() + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw std::runtime_error(std::string("scratch file: read failed: ") + std::strerror(errno));
    done += static_cast<std::size_t>(n);
  }
}

}  // namespace palpate::solver
