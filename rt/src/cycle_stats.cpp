// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/cycle_stats.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace palpate::rt {

// Values below 2^(kSubBits+1) have a bucket each. A larger value is shifted right until it lies in [64, 128);
// each shift moves it 64 buckets up.
std::size_t CycleStats::bucketOf(std::uint64_t ns) noexcept PALPATE_NONBLOCKING {
  const std::uint64_t value = std::min<std::uint64_t>(ns, (std::uint64_t{1} << kTopBits) - 1);
  const int shift = std::max(0, static_cast<int>(std::bit_width(value)) - 1 - kSubBits);
  return (static_cast<std::size_t>(shift) << kSubBits) + static_cast<std::size_t>(value >> shift);
}

std::int64_t CycleStats::upperEdge(std::size_t bucket) noexcept PALPATE_NONBLOCKING {
  const std::size_t one = std::size_t{1} << kSubBits;
  const std::size_t shift = bucket < one ? 0 : bucket / one - 1;
  const std::uint64_t mantissa = bucket - (shift << kSubBits);
  return static_cast<std::int64_t>(((mantissa + 1) << shift) - 1);
}

void CycleStats::add(std::int64_t ns) noexcept PALPATE_NONBLOCKING {
  const std::int64_t value = std::max<std::int64_t>(ns, 0);
  ++buckets_[bucketOf(static_cast<std::uint64_t>(value))];
  ++count_;
  max_ = std::max(max_, value);
}

void CycleStats::add(const CycleStats& other) noexcept PALPATE_NONBLOCKING {
  if (other.count_ == 0) return;
  for (std::size_t i = 0; i < kBuckets; ++i) buckets_[i] += other.buckets_[i];
  count_ += other.count_;
  max_ = std::max(max_, other.max_);
}

std::int64_t CycleStats::quantile(double fraction) const noexcept PALPATE_NONBLOCKING {
  const double wanted = std::ceil(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(count_));
  const auto rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(wanted));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < kBuckets && count_ > 0; ++i) {
    seen += buckets_[i];
    if (seen >= rank) return std::min(upperEdge(i), max_);
  }
  return 0;
}

}  // namespace palpate::rt
