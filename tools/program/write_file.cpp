// SPDX-License-Identifier: Apache-2.0
#include "tools/program/write_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "tools/program/exit_code.h"

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

void checkWritable(const std::filesystem::path& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (access(folder.c_str(), W_OK | X_OK) != 0) throw WriteError(file, std::strerror(errno));
  std::error_code ignored;  // a file that is not there is not a folder
  if (std::filesystem::is_directory(file, ignored)) throw WriteError(file, std::strerror(EISDIR));
}

void checkOutput(const std::string& option, const std::filesystem::path& file) {
  if (file.empty()) return;
  try {
    checkWritable(file);
  } catch (const WriteError& error) {
    throw UsageError(option + ": " + error.what());
  }
}

void checkOutputFolder(const std::string& option, const std::filesystem::path& folder) {
  if (folder.empty()) return;
  std::filesystem::path there = std::filesystem::absolute(folder);
  std::error_code ignored;  // of what is not there
  while (!std::filesystem::exists(there, ignored)) there = there.parent_path();
  const int reason = !std::filesystem::is_directory(there, ignored) ? ENOTDIR
                     : access(there.c_str(), W_OK | X_OK) != 0      ? errno
                                                                    : 0;
  if (reason != 0) throw UsageError(option + ": " + WriteError(folder, std::strerror(reason)).what());
}

bool isSameFile(const std::filesystem::path& one, const std::filesystem::path& other) {
  std::error_code ignored;  // of equivalent(): one of them is not there
  return std::filesystem::equivalent(one, other, ignored) ||
         std::filesystem::weakly_canonical(std::filesystem::absolute(one)) ==
             std::filesystem::weakly_canonical(std::filesystem::absolute(other));
}

}  // namespace palpate::program
