// SPDX-License-Identifier: Apache-2.0
#include "tools/program/write_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

namespace palpate::program {

FileBeside::FileBeside(std::filesystem::path target)
    : target_(std::move(target)), path_(target_.string() + ".tmp-" + std::to_string(getpid())) {}

FileBeside::~FileBeside() {
  std::error_code ignored;  // nothing to remove when it was never made
  if (!placed_) std::filesystem::remove(path_, ignored);
}

void FileBeside::takePlace() {
  std::error_code failure;
  std::filesystem::rename(path_, target_, failure);
  if (failure) throw WriteError(target_, failure.message());
  placed_ = true;
}

void writeFile(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  FileBeside beside(path);
  errno = 0;  // a stream only says that it failed, errno says why
  std::ofstream file(beside.path(), std::ios::binary);
  if (file) write(file);
  if (file) file.close();
  if (!file) throw WriteError(path, std::strerror(errno != 0 ? errno : EIO));
  beside.takePlace();
}

void writeFile(const std::filesystem::path& path, const std::string& content) {
  writeFile(path, [&](std::ostream& file) { file << content; });
}

}  // namespace palpate::program
