// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace palpate::solver {

/// One line of progress on standard error: done, elapsed, time left. On a terminal it overwrites itself; in a
/// log it appears at most every ten seconds. Prints nothing in the first two seconds. Any thread may call
/// advance().
class Progress {
 public:
  Progress(std::string what, std::size_t total, bool quiet = false);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(std::size_t done = 1);
  /// What need not be done: it counts neither as done nor in the time left.
  void skip(std::size_t count);
  [[nodiscard]] double seconds() const;

 private:
  void print(double elapsed);

  std::string what_;
  std::size_t total_;
  bool quiet_;
  bool terminal_;
  bool printed_{false};
  std::size_t done_{0};
  double last_print_{0.0};
  std::mutex mutex_;
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
};

}  // namespace palpate::solver
