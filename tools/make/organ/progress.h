// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace palpate::organ {

/// "12 s, about 28 s left": how long work runs already. @param expected_s  of the whole; 0: unknown, or passed: not told
[[nodiscard]] std::string progressInWords(double seconds, double expected_s);

/// Tells that work goes on, from a thread of its own, from 2 s on every 5 s, for as long as it lives. Gmsh says nothing
/// of how far it is that another thread could read: what is left follows from the estimate.
class Progress {
 public:
  using Say = std::function<void(const std::string&)>;

  /// @param say  takes each line, in another thread; empty: nothing is told  @param expected_s  as in progressInWords()
  explicit Progress(Say say, double expected_s = 0, std::chrono::milliseconds first = std::chrono::seconds(2),
                    std::chrono::milliseconds next = std::chrono::seconds(5));
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_ended_{false};
  std::thread thread_;
};

}  // namespace palpate::organ
