// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/checkpoint.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
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

bool holdsOnlyItsName(const std::filesystem::path& folder) noexcept {
  std::error_code error;
  std::filesystem::directory_iterator entries(folder, error);
  for (; !error && entries != std::filesystem::directory_iterator(); entries.increment(error))
    if (entries->path().filename() != kSolve) return false;
  return !error;
}

/// Locks the file that is the folder's lock; it goes with the folder when a solve is done. @throw CheckpointError
FileLock lockedFile(const std::filesystem::path& folder) {
  constexpr int kTries = 20;
  const std::filesystem::path name = folder / kSolve;
  for (int tries = 0; tries < kTries; ++tries) {
    std::error_code error;
    std::filesystem::create_directory(folder, error);
    if (error) throw CheckpointError(folder.string() + ": cannot be made: " + error.message());
    if (!std::filesystem::exists(name, error) && !holdsOnlyItsName(folder))
      throw CheckpointError(folder.string() + " is not a folder of palpate-solve; give another --scratch");
    try {
      if (auto lock = FileLock::take(name, FileLock::kPatience / kTries)) return std::move(*lock);
    } catch (const std::runtime_error& failure) {
      throw CheckpointError(failure.what());
    }
  }
  throw CheckpointInUse(folder.string() + ": another program solves there; give another --output");
}

}  // namespace

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

Checkpoint::Checkpoint(std::filesystem::path folder, std::span<const std::string> solve, bool fresh)
    : folder_(std::move(folder)), lock_(lockedFile(folder_)) {
  take(solve, fresh);
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
  const int lock = lock_->descriptor();
  if (ftruncate(lock, 0) != 0 ||
      pwrite(lock, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) || fsync(lock) != 0)
    throw CheckpointError(file.string() + ": cannot be written: " + std::strerror(errno));
}

Checkpoint::~Checkpoint() {
  if (holdsOnlyItsName(folder_)) remove();
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
  if (!lock_) return;
  removeParts();
  std::error_code error;
  if (holdsOnlyItsName(folder_)) unlink((folder_ / kSolve).c_str());  // last: it says whose the rest is
  rmdir(folder_.c_str());
  lock_.reset();  // whoever comes now has a folder of its own
}

}  // namespace palpate::solver
