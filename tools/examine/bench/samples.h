// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <chrono>
#include <vector>

namespace palpate::bench {

/// Times of single evaluations, one by one, on a monotonic clock.
class Samples {
 public:
  /// Runs `work` and stores its time.
  template <typename Work>
  void time(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    us_.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
  }
  void add(const Samples& other) { us_.insert(us_.end(), other.us_.begin(), other.us_.end()); }
  [[nodiscard]] std::size_t count() const noexcept { return us_.size(); }
  /// us; @param q  in [0, 1]
  [[nodiscard]] double quantile(double q) const;
  [[nodiscard]] double sum() const;  ///< us
  /// Counters p50_us and p99_us.
  void report(benchmark::State& state) const;

 private:
  std::vector<double> us_;
};

}  // namespace palpate::bench
