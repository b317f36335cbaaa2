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
      amount_(counts.f32 + counts.i16 + counts.i8),
      whole_(4 * std::max(counts.pairs(), counts.quads())),
      pair16_(counts.pairs()),
      weight16_(counts.pairs()),
      quad8_(counts.quads()),
      weight8_(counts.quads()) {}

int ModeSelection::firstSeen(float per_tolerance) const noexcept PALPATE_NONBLOCKING {
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

bool ModeSelection::anySeen(std::size_t first, std::size_t count) const noexcept PALPATE_NONBLOCKING {
  for (std::size_t k = first; k < std::min(first + count, amount_.size()); ++k)
    if (amount_[k] != 0.0F && bucketOf(amount_[k] * per_tolerance_) >= first_seen_) return true;
  return false;
}

/// Weights in units of what is returned; 0: all of them are none, or no numbers.
float ModeSelection::findWeights(std::span<const float> y, std::span<const float> scale,
                                 std::span<std::int16_t> weight) noexcept PALPATE_NONBLOCKING {
  float sum = 0.0F, most = 0.0F;
  for (std::size_t k = 0; k < scale.size(); ++k) {
    const float amount = std::abs(y[k] * scale[k]);
    sum += amount;
    most = std::max(most, amount);
  }
  const float unit = std::max(sum / static_cast<float>(kLargestSum - scale.size()), most / 32767.0F);
  if (!(sum <= std::numeric_limits<float>::max())) finite_ = false;
  if (!finite_ || !(unit >= std::numeric_limits<float>::min())) return 0.0F;
  const float per_unit = 1.0F / unit;
  for (std::size_t k = 0; k < scale.size(); ++k) {
    const float amount = y[k] * scale[k] * per_unit;
    weight[k] = static_cast<std::int16_t>(static_cast<int>(amount + (amount < 0.0F ? -0.5F : 0.5F)));
  }
  for (std::size_t k = scale.size(); k < weight.size(); ++k) weight[k] = 0;
  return unit;
}

void ModeSelection::choose(std::span<const float> y, std::span<const float> peak, const PackedModes& packed,
                           float unseen) noexcept PALPATE_NONBLOCKING {
  for (std::size_t k = 0; k < y.size(); ++k) amount_[k] = std::abs(y[k]) * peak[k];
  per_tolerance_ = unseen > 0.0F ? 1.0F / unseen : 0.0F;
  first_seen_ = unseen > 0.0F ? firstSeen(per_tolerance_) : 0;
  finite_ = true;
  count16_ = count8_ = 0;
  const std::size_t first16 = counts_.f32, first8 = counts_.f32 + counts_.i16;
  unit16_ = findWeights(y.subspan(first16), packed.scale16, std::span(whole_).first(2 * counts_.pairs()));
  for (std::size_t pair = 0; unit16_ > 0.0F && pair < counts_.pairs(); ++pair) {
    if (!anySeen(first16 + 2 * pair, 2)) continue;
    pair16_[count16_] = static_cast<std::uint32_t>(pair);
    weight16_[count16_++] = {whole_[2 * pair], whole_[2 * pair + 1]};
  }
  unit8_ =
      findWeights(y.subspan(first8), packed.scale8, std::span(whole_).first(4 * counts_.quads())) / 256.0F;
  for (std::size_t quad = 0; unit8_ > 0.0F && quad < counts_.quads(); ++quad) {
    if (!anySeen(first8 + 4 * quad, 4)) continue;
    const std::int16_t* const w = whole_.data() + 4 * quad;
    quad8_[count8_] = static_cast<std::uint32_t>(quad);
    weight8_[count8_++] = {{w[1], w[3]}, {w[0], w[2]}};
  }
}

}  // namespace palpate
