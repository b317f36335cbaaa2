// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "tools/solver/base/file_lock.h"
#include "tools/solver/base/journal.h"

namespace palpate::solver {

/// The folder of a solve that cannot be gone on with: what() names it, the reason, and what helps.
class CheckpointError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Another program is at work in it.
class CheckpointInUse : public CheckpointError {
 public:
  using CheckpointError::CheckpointError;
};

/// What differs between two solves of which each has one "name = value" a line: the first, as "NAME is now VALUE, was VALUE".
[[nodiscard]] std::string differenceOf(std::span<const std::string> now, std::span<const std::string> before);

/// What a solve has done so far, in a folder of its own: scratch files and a journal of each stage. The same solve, started again,
/// goes on where it was killed.                                                          docs/decisions/checkpoints.md
class Checkpoint {
 public:
  /// @param solve  all that decides the results, one "name = value" each
  /// @param fresh  what is in the folder is thrown away
  /// @throw CheckpointError  another solve is in it; CheckpointInUse
  Checkpoint(std::filesystem::path folder, std::span<const std::string> solve, bool fresh);
  /// An empty folder is removed.
  ~Checkpoint();
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }
  /// The one journal of a stage; lives as long as this.
  [[nodiscard]] Journal& journal(const std::string& stage);
  /// Wall time that earlier runs spent on what this one has found, s.
  [[nodiscard]] double found() const;
  /// Of what is on the disk.
  [[nodiscard]] double bytes() const;
  /// Whether an earlier run has left something.
  [[nodiscard]] bool goesOn() const noexcept { return goes_on_; }
  /// The solve is done: the folder goes, and nothing more is kept.
  void remove() noexcept;

 private:
  void take(std::span<const std::string> solve, bool fresh);
  void removeParts() noexcept;

  std::filesystem::path folder_;
  std::optional<FileLock> lock_;  ///< none: the folder is gone
  bool goes_on_{false};
  std::map<std::string, Journal> journals_;
};

}  // namespace palpate::solver
