// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/mode_selection.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace palpate {

namespace {

/// Sizes by half octaves below the tolerance: what lies more than 16 octaves below is in the first one.
constexpr int kBuckets = 32;

/// 0 to kBuckets - 1 for share < 1, kBuckets for more or what is no number.
int bucketOf(float share) noexcept {
  if (!(share < 1.0F)) return kBuckets;
  constexpr int kOne = 127 * 2;  // of 1.0F: exponent and first bit of the mantissa
  const int halves = static_cast<int>(std::bit_cast<std::uint32_t>(share) >> 22U);
  return std::max(0, halves - kOne + kBuckets);
}

}  // namespace

ModeSelection::ModeSelection(const ModeCounts& counts)
    : counts_(counts),
      amount_(counts.f32 + counts.f16 + counts.i8),
      row16_(counts.f16),
      weight16_(counts.f16),
      quad8_((counts.i8 + 3) / 4),
      weight8_(quad8_.size()) {}

int ModeSelection::firstSeen(float per_tolerance) const noexcept {
  std::array<float, kBuckets + 1> sum{};  // of shares of the tolerance
  for (const float amount : amount_) {
    const float share = amount * per_tolerance;
    sum[static_cast<std::size_t>(bucketOf(share))] += share;
  }
  float skipped = 0.0F;
  for (int bucket = 0; bucket < kBuckets; ++bucket) {
    skipped += sum[static_cast<std::size_t>(bucket)];
    if (!(skipped <= 1.0F)) return bucket;
  }
  return kBuckets;
}

void ModeSelection::choose(std::span<const float> y, std::span<const float> peak,
                           std::span<const float> scale, float unseen) noexcept PALPATE_NONBLOCKING {
  for (std::size_t k = 0; k < y.size(); ++k) amount_[k] = std::abs(y[k]) * peak[k];
  const float per_tolerance = unseen > 0.0F ? 1.0F / unseen : 0.0F;
  const int first = unseen > 0.0F ? firstSeen(per_tolerance) : 0;
  const auto seen = [&](std::size_t k) noexcept {
    return amount_[k] != 0.0F && bucketOf(amount_[k] * per_tolerance) >= first;
  };
  count16_ = 0;
  for (std::size_t row = 0; row < counts_.f16; ++row) {
    const std::size_t k = counts_.f32 + row;
    if (!seen(k)) continue;
    row16_[count16_] = static_cast<std::uint32_t>(row);
    weight16_[count16_++] = y[k] * scale[row];
  }
  chooseQuads(y.subspan(counts_.f32 + counts_.f16), scale.subspan(std::min(scale.size(), counts_.f16)), seen);
}

template <typename Seen>
void ModeSelection::chooseQuads(std::span<const float> y, std::span<const float> scale,
                                const Seen& seen) noexcept {
  const std::size_t first = counts_.f32 + counts_.f16;
  float sum = 0.0F, most = 0.0F;
  for (std::size_t k = 0; k < y.size(); ++k) {
    const float weight = std::abs(y[k] * scale[k]);
    sum += weight;
    most = std::max(most, weight);
  }
  count8_ = 0;
  unit8_ = 0.0F;
  finite_ = sum <= std::numeric_limits<float>::max();
  const float whole = std::max(sum / static_cast<float>(kLargestSum - y.size()), most / 32767.0F);
  if (!finite_ || !(whole >= std::numeric_limits<float>::min())) return;
  unit8_ = whole / 256.0F;
  const float per_whole = 1.0F / whole;
  const auto weight = [&](std::size_t k) noexcept {
    const float amount = k < y.size() ? y[k] * scale[k] * per_whole : 0.0F;
    return static_cast<std::int16_t>(static_cast<int>(amount + (amount < 0.0F ? -0.5F : 0.5F)));
  };
  for (std::size_t k = 0; k < y.size(); k += 4) {
    bool any = false;
    for (std::size_t m = k; m < std::min(k + 4, y.size()); ++m) any = any || seen(first + m);
    if (!any) continue;
    quad8_[count8_] = static_cast<std::uint32_t>(k / 4);
    weight8_[count8_++] = {{weight(k + 1), weight(k + 3)}, {weight(k), weight(k + 2)}};
  }
}

}  // namespace palpate
