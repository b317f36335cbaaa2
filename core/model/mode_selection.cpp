// SPDX-License-Identifier: Apache-2.0
#include "core/model/mode_selection.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "core/model/byte_weights.h"

namespace palpate {

namespace {

/// Sizes by half octaves below the tolerance: what lies more than 16 octaves below falls in the first.
constexpr int kBuckets = 32;

/// 0 to kBuckets - 1 for share < 1, kBuckets for more or NaN.
int bucketOf(float share) noexcept {
  if (!(share < 1.0F)) return kBuckets;
  constexpr int kOne = 127 * 2;  // of 1.0F: exponent and first bit of the mantissa
  const int halves = static_cast<int>(std::bit_cast<std::uint32_t>(share) >> 22U);
  return std::max(0, halves - kOne + kBuckets);
}

int rounded(float x) noexcept {
  return static_cast<int>(x + std::copysign(0.5F, x));
}

/// Whole-number weights leave up to 1 / 113 of a pair's larger amplitude, 1 / 2200 on average. If a quad's residual is
/// larger than this, in units, a second pass adds it while its bytes are in the cache. A unit is the sum of all amplitudes
/// over 2^24, or somewhat more; weights are rounded by up to 64.
constexpr float kLeft = 512.0F;

}  // namespace

ModeSelection::ModeSelection(const ModeCounts& counts)
    : counts_(counts),
      group_(counts.pairs() + counts.ownQuads()),
      whole_(2 * counts.pairs()),
      slot_(2 * pairBlocks(2 * counts.quads())),
      even_(slot_.size() / 2),
      odd_(even_.size()),
      left_(even_.size()),
      bytes_(even_.size()),
      weight_(even_.size()),
      again_(counts.quads()),
      pair16_(counts.pairs()),
      weight16_(counts.pairs()),
      quad8_(2 * counts.quads()),
      weight8_(2 * counts.quads()) {}

/// Which half octaves of the groups' amounts fit into what may be left out together.
void ModeSelection::findSeen(std::span<const float> y, std::span<const float> peak,
                             float unseen) noexcept PALPATE_NONBLOCKING {
  first_seen_ = 0;
  if (!(unseen > 0.0F)) return;
  const float per_tolerance = 1.0F / unseen;
  float least = std::numeric_limits<float>::infinity();
  std::size_t mode = counts_.f32;
  for (std::size_t g = 0; g < group_.size(); ++g) {
    const bool bytes = g >= counts_.pairs();
    const std::size_t end = std::min(mode + (bytes ? 4U : 2U), bytes ? y.size() : counts_.f32 + counts_.i16);
    float amount = 0.0F;
    for (; mode < end; ++mode) amount += std::abs(y[mode]) * peak[mode];
    group_[g] = amount * per_tolerance;
    least = std::min(least, group_[g]);
  }
  if (!(least <= 1.0F)) return;
  std::array<float, kBuckets + 1> sum{};
  for (const float share : group_) sum[static_cast<std::size_t>(bucketOf(share))] += share;
  float skipped = 0.0F;
  while (first_seen_ < kBuckets && (skipped += sum[static_cast<std::size_t>(first_seen_)]) <= 1.0F)
    ++first_seen_;
}

bool ModeSelection::seen(std::size_t group) const noexcept PALPATE_NONBLOCKING {
  return first_seen_ == 0 || bucketOf(group_[group]) >= first_seen_;
}

/// Weights in units of what is returned; 0: all are zero, or not finite.
float ModeSelection::findWeights(std::span<const float> y,
                                 std::span<const float> scale) noexcept PALPATE_NONBLOCKING {
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
  for (std::size_t k = 0; k < scale.size(); ++k)
    whole_[k] = static_cast<std::int16_t>(rounded(y[k] * scale[k] * per_unit));
  return unit;
}

void ModeSelection::chooseInt16(std::span<const float> y,
                                std::span<const float> scale) noexcept PALPATE_NONBLOCKING {
  unit16_ = findWeights(y, scale);
  for (std::size_t pair = 0; unit16_ > 0.0F && pair < counts_.pairs(); ++pair) {
    const WeightPair weights{whole_[2 * pair], whole_[2 * pair + 1]};
    if (!seen(pair) || weights == WeightPair{}) continue;
    pair16_[count16_] = static_cast<std::uint32_t>(pair);
    weight16_[count16_++] = weights;
  }
}

/// Amplitudes of all bytes: of modes in quads that are seen, and of what they share.
void ModeSelection::findSlots(std::span<const float> y,
                              std::span<const float> scale) noexcept PALPATE_NONBLOCKING {
  for (std::size_t row = 0; row < y.size(); ++row) slot_[row] = y[row] * scale[row];
  std::fill(slot_.begin() + static_cast<std::ptrdiff_t>(y.size()), slot_.end(), 0.0F);
  for (std::size_t quad = 0; first_seen_ > 0 && quad < counts_.ownQuads(); ++quad)
    if (!seen(counts_.pairs() + quad))
      std::fill_n(slot_.begin() + static_cast<std::ptrdiff_t>(4 * quad), 4, 0.0F);
  for (std::size_t row = 0; row < counts_.bits10; ++row) {
    const SharedByte shared = sharedByte(counts_, row);
    slot_[shared.slot] += slot_[row] * (static_cast<float>(shared.share) / 256.0F);
  }
}

/// So that neither a sum nor the weight of a pair gets too large; 0 as above.
float ModeSelection::unitOfBytes() noexcept PALPATE_NONBLOCKING {
  const Amounts amounts = amountsOf(slot_.data(), slot_.size());
  const float room =
      0.97F * static_cast<float>(kLargestByteSum) - 64.0F * 4.0F * static_cast<float>(counts_.quads());
  const float unit = std::max(amounts.sum / room, amounts.most / (kLeastByte * 32767.0F));
  if (!(amounts.sum <= std::numeric_limits<float>::max())) finite_ = false;
  return finite_ && unit >= std::numeric_limits<float>::min() ? unit : 0.0F;
}

void ModeSelection::splitSlots() noexcept PALPATE_NONBLOCKING {
  for (std::size_t pair = 0; pair < even_.size(); ++pair) {
    even_[pair] = slot_[2 * pair];
    odd_[pair] = slot_[2 * pair + 1];
  }
}

/// @param first  of its two pairs of weights
void ModeSelection::addQuad(std::size_t quad, std::size_t first) noexcept PALPATE_NONBLOCKING {
  QuadWeights weights{{}, {weight_[first], weight_[first + 1]}};
  if (weights.pair == WeightPair{}) return;
  for (std::size_t two = 0; two < 2; ++two) {
    const auto both = static_cast<std::uint16_t>(bytes_[first + two]);
    weights.byte[2 * two] = static_cast<std::int8_t>(both & 255U);
    weights.byte[2 * two + 1] = static_cast<std::int8_t>(both >> 8U);
  }
  quad8_[count8_] = static_cast<std::uint32_t>(quad);
  weight8_[count8_++] = weights;
}

void ModeSelection::chooseBytes(std::span<const float> y,
                                std::span<const float> scale) noexcept PALPATE_NONBLOCKING {
  findSlots(y, scale);
  unit8_ = unitOfBytes();
  if (!(unit8_ > 0.0F)) return;
  splitSlots();
  const BytePairs pairs{even_.data(), odd_.data(), left_.data(), bytes_.data(), weight_.data()};
  auto products = static_cast<std::uint32_t>(weighPairs(pairs, 2 * counts_.quads(), unit8_));
  std::size_t again = 0;
  for (std::size_t quad = 0; quad < counts_.quads(); ++quad) {
    addQuad(quad, 2 * quad);
    again_[again] = static_cast<std::uint32_t>(quad);
    again += std::max(left_[2 * quad], left_[2 * quad + 1]) > kLeft * unit8_ ? 1 : 0;
  }
  for (std::size_t k = 0; k < 2 * again; ++k) {  // to the front, whose entries are used up
    const std::size_t pair = 2 * std::size_t{again_[k / 2]} + k % 2;
    even_[k] = even_[pair];
    odd_[k] = odd_[pair];
  }
  const auto end = static_cast<std::ptrdiff_t>(pairBlocks(2 * again));
  std::fill(even_.begin() + static_cast<std::ptrdiff_t>(2 * again), even_.begin() + end, 0.0F);
  std::fill(odd_.begin() + static_cast<std::ptrdiff_t>(2 * again), odd_.begin() + end, 0.0F);
  if (again > 0) products += static_cast<std::uint32_t>(weighPairs(pairs, 2 * again, unit8_));
  for (std::size_t k = 0; k < again; ++k) addQuad(again_[k], 2 * k);
  start8_ = static_cast<std::int32_t>(0U - 128U * products);
}

void ModeSelection::choose(std::span<const float> y, std::span<const float> peak, const PackedModes& packed,
                           float unseen) noexcept PALPATE_NONBLOCKING {
  findSeen(y, peak, unseen);
  finite_ = true;
  count16_ = count8_ = 0;
  unit16_ = unit8_ = 0.0F;
  start8_ = 0;
  const auto packed_y = y.subspan(counts_.f32);
  chooseInt16(packed_y.first(counts_.i16), packed.scale.first(counts_.i16));
  chooseBytes(packed_y.subspan(counts_.i16), packed.scale.subspan(counts_.i16));
}

}  // namespace palpate
