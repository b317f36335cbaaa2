// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/progress.h"

#include <utility>

#include "tools/program/printed.h"

namespace palpate::organ {

std::string progressInWords(double seconds, double expected_s) {
  const std::string words = program::printed("%.0f s", seconds);
  return expected_s > seconds ? words + program::printed(", about %.0f s left", expected_s - seconds) : words;
}

Progress::Progress(Say say, double expected_s, std::chrono::milliseconds first,
                   std::chrono::milliseconds next) {
  if (!say) return;
  thread_ = std::thread([this, say = std::move(say), expected_s, first, next] {
    const auto start = std::chrono::steady_clock::now();
    auto at = start + first;
    std::unique_lock lock(mutex_);
    for (; !ended_.wait_until(lock, at, [&] { return is_ended_; }); at += next)
      say(progressInWords(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                          expected_s));
  });
}

Progress::~Progress() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_ended_ = true;
  }
  ended_.notify_one();
  thread_.join();
}

}  // namespace palpate::organ
