// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace palpate::client {

// Values below 2^6 have a bucket each; above, the six bits after the leading one choose within the power of
// two.
std::size_t Histogram::bucketOf(std::uint64_t ns) noexcept {
  if (ns < (1U << kSubBits)) return static_cast<std::size_t>(ns);
  const auto power = static_cast<unsigned>(std::bit_width(ns)) - 1;
  if (power >= kTopBit) return kBuckets - 1;
  const unsigned shift = power - kSubBits;
  return ((static_cast<std::size_t>(shift) + 1) << kSubBits) + ((ns >> shift) - (1U << kSubBits));
}

// The largest value that falls into the bucket.
std::uint64_t Histogram::lastOf(std::size_t bucket) noexcept {
  const std::size_t group = bucket >> kSubBits;
  if (group == 0) return bucket;
  const std::size_t shift = group - 1;
  const std::uint64_t leading = (bucket & ((1U << kSubBits) - 1)) + (1U << kSubBits);
  return ((leading + 1) << shift) - 1;
}

void Histogram::add(std::int64_t time_ns) noexcept {
  const std::int64_t clamped = std::max<std::int64_t>(time_ns, 0);
  ++buckets_[bucketOf(static_cast<std::uint64_t>(clamped))];
  ++count_;
  max_ = std::max(max_, clamped);
}

std::int64_t Histogram::percentile(double q) const noexcept {
  if (count_ == 0) return 0;
  const auto wanted =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(count_))));
  std::uint64_t seen = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    seen += buckets_[bucket];
    if (seen >= wanted && bucket + 1 < kBuckets)
      return std::min(static_cast<std::int64_t>(lastOf(bucket)), max_);
  }
  return max_;
}

TimeSummary Histogram::summary() const noexcept {
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
  return {us(percentile(0.5)), us(percentile(0.99)), us(percentile(0.999)), us(max_), count_};
}

std::vector<HistogramBar> Histogram::bars(int per_decade) const {
  const auto barOf = [per_decade](std::size_t bucket) {
    return static_cast<int>(
        std::floor(std::log10(std::max<double>(static_cast<double>(lastOf(bucket)), 1.0)) * per_decade));
  };
  std::vector<HistogramBar> bars;
  int first = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    if (buckets_[bucket] == 0) continue;
    if (bars.empty()) first = barOf(bucket);
    while (static_cast<int>(bars.size()) <= barOf(bucket) - first) {
      const double exponent = first + static_cast<double>(bars.size());
      bars.push_back({std::pow(10.0, exponent / per_decade), std::pow(10.0, (exponent + 1) / per_decade), 0});
    }
    bars.back().count += buckets_[bucket];
  }
  return bars;
}

}  // namespace palpate::client
