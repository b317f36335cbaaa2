// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palpate/testing/child_process.h"
#include "palpate/testing/files.h"

namespace palpate::testing {

/// palpate-viewer as its own process on a free port, with a page of one line. The destructor kills it if it still runs.
class ViewerProcess {
 public:
  /// Waits for its first line, for at most 20 s.
  explicit ViewerProcess(const std::string& domain, const std::vector<std::string>& more = {});

  /// 0: it did not start to listen.
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  /// Its first line on standard output.
  [[nodiscard]] const std::string& announcement() const noexcept { return announcement_; }

  [[nodiscard]] bool running() { return process_->running(); }
  /// Sends a signal and waits. @return exit code, 128 + n when signal n ended it, -1 when it still runs after 20 s
  int end(int signal);

 private:
  TemporaryFolder page_;
  std::optional<ChildProcess> process_;
  std::uint16_t port_{0};
  std::string announcement_;
};

}  // namespace palpate::testing
