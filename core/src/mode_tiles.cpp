// SPDX-License-Identifier: Apache-2.0
#include "mode_tiles.h"

#include <algorithm>

#include "palpate/core/packed_modes.h"

// Vectors of unknown size cannot stand in arrays.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mode_tiles.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace palpate {
namespace HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR  // processors without vectors, one number at a time

constexpr std::size_t kStep = kTile;

void addPairs(const std::int16_t* X16, const TileWeights& w, float* u) {
  for (std::size_t i = 0; i < kStep; ++i) {
    std::int32_t sum = 0;
    for (std::size_t p = 0; p < w.count16; ++p) {
      const std::int16_t* const pair = X16 + (w.pair16[p] * kTile + i) * 2;
      sum += pair[0] * w.weight16[p][0] + pair[1] * w.weight16[p][1];
    }
    u[i] += w.unit16 * static_cast<float>(sum);
  }
}

/// What sixteen bits that hold two numbers stand for: as they are, and moved up by eight bits.
std::int32_t upper(const std::int8_t* two) {
  return 256 * two[1] + static_cast<std::uint8_t>(two[0]);
}
std::int32_t lower(const std::int8_t* two) {
  return 256 * two[0];
}

void addQuads(const std::int8_t* X8, const TileWeights& w, float* u) {
  for (std::size_t i = 0; i < kStep; ++i) {
    std::int32_t sum = 0;
    for (std::size_t q = 0; q < w.count8; ++q) {
      const std::int8_t* const ab = X8 + (w.quad8[q] * kTile + i) * 4;
      const QuadWeights& weight = w.weight8[q];
      sum += upper(ab) * weight.bd[0] + upper(ab + 2) * weight.bd[1];
      sum += lower(ab) * weight.ac[0] + lower(ab + 2) * weight.ac[1];
    }
    u[i] += w.unit8 * static_cast<float>(sum);
  }
}

#else

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::Rebind<std::int32_t, Floats>;
using Shorts = hn::Repartition<std::int16_t, Floats>;

constexpr std::size_t kLanes = HWY_LANES(float);
/// Vectors that stay in registers, of sixteen that every processor has.
constexpr std::size_t kVectors = kTile / kLanes < 8 ? kTile / kLanes : 8;
constexpr std::size_t kStep = kVectors * kLanes;

HWY_INLINE hn::Vec<Shorts> bothOf(const WeightPair& pair) {
  const auto low = static_cast<std::uint16_t>(pair[0]), high = static_cast<std::uint16_t>(pair[1]);
  const std::uint32_t both = low | (std::uint32_t{high} << 16U);
  return hn::BitCast(Shorts(), hn::Set(Ints(), static_cast<std::int32_t>(both)));
}

/// u += unit * sums.
HWY_INLINE void addSums(const hn::Vec<Ints>* first, const hn::Vec<Ints>* second, float unit, float* u) {
  const Floats df;
  for (std::size_t k = 0; k < kVectors; ++k) {
    const auto sum = hn::ConvertTo(df, hn::RearrangeToOddPlusEven(first[k], second[k]));
    hn::StoreU(hn::MulAdd(hn::Set(df, unit), sum, hn::LoadU(df, u + k * kLanes)), df, u + k * kLanes);
  }
}

/// u += sum of int16 pairs, kVectors of them at a time. @param X16  of the tile, at these numbers
HWY_INLINE void addPairs(const std::int16_t* X16, const TileWeights& w, float* u) {
  const Ints di;
  hn::Vec<Ints> first[kVectors], second[kVectors];
  for (std::size_t k = 0; k < kVectors; ++k) first[k] = second[k] = hn::Zero(di);
  for (std::size_t p = 0; p < w.count16; ++p) {
    const std::int16_t* const pair = X16 + w.pair16[p] * kTile * 2;
    const auto weight = bothOf(w.weight16[p]);
    for (std::size_t k = 0; k < kVectors; ++k) {
      const auto two = hn::LoadU(Shorts(), pair + 2 * k * kLanes);
      first[k] = hn::ReorderWidenMulAccumulate(di, two, weight, first[k], second[k]);
    }
  }
  addSums(first, second, w.unit16, u);
}

/// u += sum of int8 quads. Sixteen bits hold a and b: as they stand 256 b, moved up by eight bits 256 a.
HWY_INLINE void addQuads(const std::int8_t* X8, const TileWeights& w, float* u) {
  const Ints di;
  hn::Vec<Ints> first[kVectors], second[kVectors];
  for (std::size_t k = 0; k < kVectors; ++k) first[k] = second[k] = hn::Zero(di);
  for (std::size_t q = 0; q < w.count8; ++q) {
    const auto* const quad =
        static_cast<const std::int16_t*>(static_cast<const void*>(X8 + w.quad8[q] * kTile * 4));
    const auto bd = bothOf(w.weight8[q].bd), ac = bothOf(w.weight8[q].ac);
    for (std::size_t k = 0; k < kVectors; ++k) {
      const auto four = hn::LoadU(Shorts(), quad + 2 * k * kLanes);
      first[k] = hn::ReorderWidenMulAccumulate(di, four, bd, first[k], second[k]);
      first[k] = hn::ReorderWidenMulAccumulate(di, hn::ShiftLeft<8>(four), ac, first[k], second[k]);
    }
  }
  addSums(first, second, w.unit8, u);
}

#endif

void AddTiles(const PackedModes& modes, std::size_t pairs, std::size_t quads, const TileWeights& w,
              std::span<float> u) {
  for (std::size_t first = 0; first < u.size(); first += kTile) {
    const std::size_t tile = first / kTile, size = std::min(kTile, u.size() - first);
    float last[kTile] = {};
    float* const out = size == kTile ? u.data() + first : last;
    if (size < kTile) std::copy_n(u.data() + first, size, last);
    for (std::size_t i = 0; i < kTile; i += kStep) {
      if (w.count16 > 0) addPairs(modes.X16.data() + (tile * pairs * kTile + i) * 2, w, out + i);
      if (w.count8 > 0) addQuads(modes.X8.data() + (tile * quads * kTile + i) * 4, w, out + i);
    }
    if (size < kTile) std::copy_n(last, size, u.data() + first);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace palpate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate {

PALPATE_TRUSTED_BEGIN  // as in kernels.cpp

    HWY_EXPORT(AddTiles);

void addTiles(const PackedModes& modes, std::size_t pairs, std::size_t quads, const TileWeights& weights,
              std::span<float> u) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddTiles)(modes, pairs, quads, weights, u);
}

PALPATE_TRUSTED_END

}  // namespace palpate
#endif
