// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/checkpoint.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace palpate::solver {

namespace {

constexpr const char* kSolve = "solve";  ///< the file that says whose the folder is; also its lock
constexpr const char* kFormat = "palpate-solve checkpoint 1";  ///< its first line

std::vector<std::string> linesOf(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string nameOf(const std::string& line) {
  return line.substr(0, line.find(" = "));
}

/// The first line that differs, as "NAME is now VALUE, was VALUE".
std::string differenceOf(std::span<const std::string> now, std::span<const std::string> before) {
  const auto lineWith = [](std::span<const std::string> lines, const std::string& name) {
    const auto found = std::find_if(lines.begin(), lines.end(),
                                    [&](const std::string& line) { return nameOf(line) == name; });
    return found == lines.end() ? std::string("absent")
                                : found->substr(std::min(found->size(), name.size() + 3));
  };
  for (const auto& lines : {now, before})
    for (const std::string& line : lines) {
      const std::string name = nameOf(line), is = lineWith(now, name), was = lineWith(before, name);
      if (is != was) return name + " is now " + is + ", was " + was;
    }
  return "its lines are in another order";
}

bool holdsOnlyItsName(const std::filesystem::path& folder) noexcept {
  std::error_code error;
  std::filesystem::directory_iterator entries(folder, error);
  for (; !error && entries != std::filesystem::directory_iterator(); entries.increment(error))
    if (entries->path().filename() != kSolve) return false;
  return !error;
}

/// Whether a name still leads to an open file: the folder of a solve that is done goes with its lock.
bool leadsTo(const std::filesystem::path& name, int file) {
  struct stat of_name {
  }, of_file{};
  return stat(name.c_str(), &of_name) == 0 && fstat(file, &of_file) == 0 &&
         of_name.st_ino == of_file.st_ino && of_name.st_dev == of_file.st_dev;
}

/// Opens the file that is the folder's lock, and locks it. A process that was killed has its own until the kernel has taken its
/// memory back. @throw CheckpointError
int lockedFile(const std::filesystem::path& folder) {
  const std::filesystem::path name = folder / kSolve;
  for (int tries = 0; tries < 20; ++tries) {
    std::error_code error;
    std::filesystem::create_directory(folder, error);
    if (error) throw CheckpointError(folder.string() + ": cannot be made: " + error.message());
    if (!std::filesystem::exists(name, error) && !holdsOnlyItsName(folder))
      throw CheckpointError(folder.string() + " is not a folder of palpate-solve; give another --scratch");
    const int file = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file < 0 && errno == ENOENT) continue;  // the folder has just gone
    if (file < 0) throw CheckpointError(name.string() + ": cannot be opened: " + std::strerror(errno));
    const int failed = flock(file, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    if (failed == 0 && leadsTo(name, file)) return file;
    close(file);
    if (failed != 0 && failed != EWOULDBLOCK && failed != EINTR)
      throw CheckpointError(name.string() + ": cannot be locked: " + std::strerror(failed));
    if (failed != 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  throw CheckpointError(folder.string() + ": another program solves there; give another --output");
}

}  // namespace

Checkpoint::Checkpoint(std::filesystem::path folder, std::span<const std::string> solve, bool fresh)
    : folder_(std::move(folder)), lock_(lockedFile(folder_)) {
  try {
    take(solve, fresh);
  } catch (...) {
    close(lock_);
    throw;
  }
}

void Checkpoint::take(std::span<const std::string> solve, bool fresh) {
  const std::filesystem::path file = folder_ / kSolve;
  std::vector<std::string> now{kFormat};
  now.insert(now.end(), solve.begin(), solve.end());
  const std::vector<std::string> before = linesOf(file);
  if (!holdsOnlyItsName(folder_) && (before.empty() || before.front() != kFormat))
    throw CheckpointError(folder_.string() + " is not a folder of palpate-solve; give another --scratch");
  if (!fresh && before == now) {
    goes_on_ = !holdsOnlyItsName(folder_);
    return;
  }
  if (!fresh && !holdsOnlyItsName(folder_))
    throw CheckpointError(folder_.string() + " holds parts of another solve: " + differenceOf(now, before) +
                          "; --fresh begins again");
  removeParts();
  if (!holdsOnlyItsName(folder_))
    throw CheckpointError(folder_.string() + ": what an earlier run has left cannot be removed");
  std::string text;
  for (const std::string& line : now) text += line + '\n';
  if (ftruncate(lock_, 0) != 0 ||
      pwrite(lock_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) || fsync(lock_) != 0)
    throw CheckpointError(file.string() + ": cannot be written: " + std::strerror(errno));
}

Checkpoint::~Checkpoint() {
  if (holdsOnlyItsName(folder_)) remove();
  if (lock_ >= 0) close(lock_);
}

Journal& Checkpoint::journal(const std::string& stage) {
  return journals_.try_emplace(stage, folder_ / (stage + ".journal")).first->second;
}

double Checkpoint::found() const {
  double seconds = 0.0;
  for (const auto& [stage, journal] : journals_) seconds += journal.found();
  return seconds;
}

double Checkpoint::bytes() const {
  double all = 0.0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    all += static_cast<double>(entry.file_size());
  return all;
}

void Checkpoint::removeParts() noexcept {
  std::error_code error;
  std::filesystem::directory_iterator entries(folder_, error);
  for (; !error && entries != std::filesystem::directory_iterator(); entries.increment(error))
    if (entries->path().filename() != kSolve) unlink(entries->path().c_str());
}

void Checkpoint::remove() noexcept {
  if (lock_ < 0) return;
  removeParts();
  std::error_code error;
  if (holdsOnlyItsName(folder_)) unlink((folder_ / kSolve).c_str());  // last: it says whose the rest is
  rmdir(folder_.c_str());
  close(std::exchange(lock_, -1));  // whoever comes now has a folder of its own
}

}  // namespace palpate::solver
