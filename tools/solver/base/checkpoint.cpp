// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/checkpoint.h"

#include <fcntl.h>
#include <sys/file.h>
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
  return {};
}

bool holdsOnlyItsName(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::directory_iterator entries(folder, error);
  return std::all_of(begin(entries), end(entries),
                     [](const auto& entry) { return entry.path().filename() == kSolve; });
}

/// A process that was killed has its lock until the kernel has taken its memory back.
bool locked(int file) {
  for (int tries = 0; tries < 20; ++tries) {
    if (flock(file, LOCK_EX | LOCK_NB) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

}  // namespace

Checkpoint::Checkpoint(std::filesystem::path folder, std::span<const std::string> solve, bool fresh)
    : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directory(folder_, error);
  const std::filesystem::path file = folder_ / kSolve;
  lock_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) throw CheckpointError(file.string() + ": cannot be opened: " + std::strerror(errno));
  try {
    if (!locked(lock_))
      throw CheckpointError(folder_.string() + ": another program solves there; give another --output");
    take(solve, fresh);
  } catch (...) {
    close(lock_);
    throw;
  }
}

void Checkpoint::take(std::span<const std::string> solve, bool fresh) {
  const std::filesystem::path file = folder_ / kSolve;
  const std::vector<std::string> before = linesOf(file);
  if (!fresh && std::equal(before.begin(), before.end(), solve.begin(), solve.end())) {
    goes_on_ = !holdsOnlyItsName(folder_);
    return;
  }
  if (!fresh && !before.empty())
    throw CheckpointError(folder_.string() + " holds parts of another solve: " + differenceOf(solve, before) +
                          "; --fresh begins again");
  if (before.empty() && !holdsOnlyItsName(folder_))
    throw CheckpointError(folder_.string() + " is not a folder of palpate-solve; give another --scratch");
  removeAllBut(kSolve);
  std::ofstream out(file, std::ios::trunc);
  for (const std::string& line : solve) out << line << '\n';
  if (!out.flush()) throw CheckpointError(file.string() + ": cannot be written");
}

Checkpoint::~Checkpoint() {
  if (holdsOnlyItsName(folder_)) remove();
  close(lock_);
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

void Checkpoint::removeAllBut(const char* kept) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error))
    if (entry.path().filename() != kept) std::filesystem::remove(entry.path(), error);
}

void Checkpoint::remove() {
  removeAllBut(kSolve);  // which says whose the folder is until it is empty
  std::error_code error;
  std::filesystem::remove(folder_ / kSolve, error);
  std::filesystem::remove(folder_, error);
}

}  // namespace palpate::solver
