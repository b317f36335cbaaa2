// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace palpate::solver {

Progress::Progress(std::string what, std::size_t total, bool quiet)
    : what_(std::move(what)), total_(total), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (printed_ && terminal_) std::fputc('\n', stderr);
}

double Progress::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::advance(std::size_t done) {
  const std::lock_guard lock(mutex_);
  done_ += done;
  const double elapsed = seconds();
  const double interval = terminal_ ? 0.2 : 10.0;
  const bool end = done_ >= total_ && printed_;
  if (quiet_ || elapsed < 2.0 || (elapsed - last_print_ < interval && !end)) return;
  last_print_ = elapsed;
  print(elapsed);
}

void Progress::skip(std::size_t count) {
  const std::lock_guard lock(mutex_);
  total_ -= count;
}

void Progress::print(double elapsed) {
  const double share = static_cast<double>(done_) / static_cast<double>(std::max<std::size_t>(total_, 1));
  const double left = elapsed * (1.0 - share) / std::max(share, 1e-9);
  std::fprintf(stderr, "%s%s: %zu of %zu (%.0f %%), %.0f s, %.0f s left%s", terminal_ ? "\r" : "",
               what_.c_str(), done_, total_, 100.0 * share, elapsed, left, terminal_ ? "   " : "\n");
  printed_ = true;
}

}  // namespace palpate::solver
