// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate::rt {

/// Percentiles of durations from counts alone: a histogram whose buckets are linear within each power of
/// two, 64 to a power, so that a value is known within 1/64 from 1 ns to 18 minutes. Longer ones count as the
/// last bucket. Threads: one. Real-time: yes; quantile() walks all buckets, about 1 us.
class CycleStats {
  static constexpr int kSubBits = 6;   // 64 buckets to a power of two
  static constexpr int kTopBits = 40;  // values below 2^40 ns

 public:
  static constexpr std::size_t kBuckets = (kTopBits - kSubBits + 1) << kSubBits;

  /// `count` durations of at most `upper_ns`, longer than those of the bucket before.
  struct Bucket {
    std::int64_t upper_ns;
    std::uint64_t count;
  };

  /// @param[in] ns  a duration; negative counts as 0
  void add(std::int64_t ns) noexcept PALPATE_NONBLOCKING;

  /// All durations of another one. Cost that of quantile().
  void add(const CycleStats& other) noexcept PALPATE_NONBLOCKING;

  /// @param[in] fraction  in [0, 1]: 0.5 is the median
  /// @return upper edge of the bucket that holds the quantile, never above max(), ns; 0 when empty
  [[nodiscard]] std::int64_t quantile(double fraction) const noexcept PALPATE_NONBLOCKING;

  [[nodiscard]] std::int64_t max() const noexcept PALPATE_NONBLOCKING { return max_; }  ///< exact, ns
  [[nodiscard]] std::uint64_t count() const noexcept PALPATE_NONBLOCKING { return count_; }

  /// @param[in] index  below kBuckets; ascending with the durations
  [[nodiscard]] Bucket bucket(std::size_t index) const noexcept PALPATE_NONBLOCKING {
    return {upperEdge(index), buckets_[index]};
  }

  void clear() noexcept PALPATE_NONBLOCKING { *this = CycleStats{}; }

 private:
  static std::size_t bucketOf(std::uint64_t ns) noexcept PALPATE_NONBLOCKING;
  static std::int64_t upperEdge(std::size_t bucket) noexcept PALPATE_NONBLOCKING;

  std::array<std::uint32_t, kBuckets> buckets_{};
  std::uint64_t count_{0};
  std::int64_t max_{0};
};

}  // namespace palpate::rt
