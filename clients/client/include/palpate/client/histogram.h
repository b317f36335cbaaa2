// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpate::client {

/// What a distribution of times is reported as, us.
struct TimeSummary {
  double p50{0.0};
  double p99{0.0};
  double p999{0.0};
  double max{0.0};
  std::uint64_t count{0};
};

/// One bar of a histogram: `count` values in (from_ns, to_ns].
struct HistogramBar {
  double from_ns;
  double to_ns;
  std::uint64_t count;
};

/// A distribution of times that keeps counts, not values: 64 buckets for each power of two, so a percentile
/// is at most 1/64 above the true one. Clients cannot link rt, which has its own for the server's side.
/// Threads: one. Real-time: add() yes.
class Histogram {
 public:
  /// @param[in] time_ns  a time, ns; negative counts as 0, beyond 2^40 (18 minutes) as the last bucket
  void add(std::int64_t time_ns) noexcept;

  /// The smallest bucket edge that at least the fraction q of all values do not exceed, and never above
  /// max().
  /// @param[in] q  in [0, 1]
  /// @return ns, 0 when empty
  [[nodiscard]] std::int64_t percentile(double q) const noexcept;
  [[nodiscard]] std::int64_t max() const noexcept { return max_; }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] TimeSummary summary() const noexcept;

  /// Bars of equal width on a logarithmic axis, from the first value's to the last one's, empty ones in
  /// between included; empty when no value was added.
  /// @param[in] per_decade  bars for a factor of ten, in [1, 50]
  [[nodiscard]] std::vector<HistogramBar> bars(int per_decade) const;

 private:
  static constexpr unsigned kSubBits = 6;
  static constexpr unsigned kTopBit = 40;
  static constexpr std::size_t kBuckets = (kTopBit - kSubBits + 1) << kSubBits;

  [[nodiscard]] static std::size_t bucketOf(std::uint64_t ns) noexcept;
  [[nodiscard]] static std::uint64_t lastOf(std::size_t bucket) noexcept;

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_{0};
  std::int64_t max_{0};
};

}  // namespace palpate::client
