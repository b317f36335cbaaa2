// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace palpate::testing {

/// A program of this build as its own process, started without a shell. The destructor kills it if it still runs.
class ChildProcess {
 public:
  /// Where its standard streams go, borrowed; -1: where those of the test go.
  struct Streams {
    int out{-1};
    int err{-1};
  };

  /// Which processes the destructor kills.
  enum class Kills {
    kProgram,
    kGroup,  ///< also those that it has started: all are in a process group of its own
  };

  /// @param[in] program  e.g. "palpate-tool"; a path when it has a slash
  /// @throw std::runtime_error  it cannot be started
  ChildProcess(const std::string& program, std::vector<std::string> arguments, const Streams& streams,
               Kills kills = Kills::kProgram);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] bool running();
  /// Does nothing once it has ended.
  void signal(int number) const;
  /// @return exit code; 128 + n when signal n ended it; -1 when it still runs after the timeout
  [[nodiscard]] int waitForExit(std::chrono::seconds timeout);
  /// The same, however long it takes.
  [[nodiscard]] int waitForExit();

  /// -1 once it has ended.
  [[nodiscard]] pid_t pid() const noexcept { return pid_; }

 private:
  void ended(int status) noexcept;

  pid_t pid_{-1}, group_{-1};  ///< no group of its own: -1
  int exit_code_{-1};
};

/// What a process writes, kept in memory: no file to name and remove.
class CaughtOutput {
 public:
  /// @throw std::runtime_error  there is no memory for it
  CaughtOutput();
  ~CaughtOutput();
  CaughtOutput(const CaughtOutput&) = delete;
  CaughtOutput& operator=(const CaughtOutput&) = delete;
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  /// All that was written so far.
  [[nodiscard]] std::string text() const;

 private:
  int descriptor_;
};

}  // namespace palpate::testing
