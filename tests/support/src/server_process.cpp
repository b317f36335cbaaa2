// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/server_process.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "palpate/testing/timed_tests.h"

namespace palpate::testing {

namespace {

// Tests have their domain to themselves: no need to listen for long.
std::vector<std::string> withShortListening(std::vector<std::string> arguments) {
  const auto said = std::find(arguments.begin(), arguments.end(), "--listen-first");
  if (said == arguments.end()) arguments.insert(arguments.end(), {"--listen-first", "0.05"});
  return arguments;
}

}  // namespace

ServerProcess::ServerProcess(const std::vector<std::string>& arguments, int log_fd)
    : process_("palpate-server", withShortListening(arguments),
               {.err = log_fd >= 0 ? log_fd : log_.descriptor()}) {}

ServerProcess::~ServerProcess() {
  constexpr int kBySignal = 128;  // and its number
  if (process_.running()) return;
  const int code = process_.waitForExit(std::chrono::seconds(0));
  if (code > kBySignal && code != kBySignal + sent_) countAlways();
}

}  // namespace palpate::testing
