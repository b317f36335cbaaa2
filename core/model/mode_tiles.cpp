// SPDX-License-Identifier: Apache-2.0
#include "core/model/mode_tiles.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/data/packed_modes.h"

// Vectors of unknown size cannot stand in arrays.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/model/mode_tiles.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace palpate {
namespace HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR  // processors without vectors, one number at a time

constexpr std::size_t kStep = kTile;

void addPairs(const std::int16_t* X16, const TileWeights& w, bool onto, float* u) {
  for (std::size_t i = 0; i < kStep; ++i) {
    std::int32_t sum = 0;
    for (std::size_t p = 0; p < w.count16; ++p) {
      const std::int16_t* const pair = X16 + (w.pair16[p] * kTile + i) * 2;
      sum += pair[0] * w.weight16[p][0] + pair[1] * w.weight16[p][1];
    }
    u[i] = (onto ? u[i] : 0.0F) + w.unit16 * static_cast<float>(sum);
  }
}

void addQuads(const std::uint8_t* X8, const TileWeights& w, bool onto, float* u) {
  for (std::size_t i = 0; i < kStep; ++i) {
    auto sum = static_cast<std::uint32_t>(w.start8);  // may wrap round and back
    for (std::size_t q = 0; q < w.count8; ++q) {
      const std::uint8_t* const four = X8 + (w.quad8[q] * kTile + i) * 4;
      const QuadWeights& weight = w.weight8[q];
      const int first = four[0] * weight.byte[0] + four[1] * weight.byte[1];
      const int second = four[2] * weight.byte[2] + four[3] * weight.byte[3];
      sum += static_cast<std::uint32_t>(first * weight.pair[0]) +
             static_cast<std::uint32_t>(second * weight.pair[1]);
    }
    u[i] = (onto ? u[i] : 0.0F) + w.unit8 * static_cast<float>(static_cast<std::int32_t>(sum));
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

/// u = unit * (start + sums), onto u or not.
HWY_INLINE void addSums(const hn::Vec<Ints>* first, const hn::Vec<Ints>* second, std::int32_t start,
                        float unit, bool onto, float* u) {
  const Floats df;
  for (std::size_t k = 0; k < kVectors; ++k) {
    const auto whole = hn::Add(hn::RearrangeToOddPlusEven(first[k], second[k]), hn::Set(Ints(), start));
    const auto sum = hn::ConvertTo(df, whole);
    const auto base = onto ? hn::LoadU(df, u + k * kLanes) : hn::Zero(df);
    hn::StoreU(hn::MulAdd(hn::Set(df, unit), sum, base), df, u + k * kLanes);
  }
}

/// Asks for what is read a little later; beyond the end nothing happens. @param from  kVectors vectors
HWY_INLINE void fetchAhead(const std::int16_t* from) {
  constexpr std::size_t kAhead = 2048 / sizeof(std::int16_t), kLine = 64 / sizeof(std::int16_t);
  for (std::size_t i = 0; i < 2 * kStep; i += kLine) hwy::Prefetch(from + kAhead + i);
}

// Loops are do-while and unrolled by four: otherwise gcc copies the sums between registers each round, 4 to 7 %.

/// The sum of int16 pairs, kVectors of them at a time. @param X16  of the tile, at these numbers
/// @param w  with at least one pair
HWY_INLINE void addPairs(const std::int16_t* X16, const TileWeights& w, bool onto, float* u) {
  const Ints di;
  hn::Vec<Ints> first[kVectors], second[kVectors];
  for (std::size_t k = 0; k < kVectors; ++k) first[k] = second[k] = hn::Zero(di);
  std::size_t p = 0;
#pragma GCC unroll 4
  do {
    const std::int16_t* const pair = X16 + w.pair16[p] * kTile * 2;
    fetchAhead(pair);
    const auto weight = bothOf(w.weight16[p]);
    for (std::size_t k = 0; k < kVectors; ++k) {
      const auto two = hn::LoadU(Shorts(), pair + 2 * k * kLanes);
      first[k] = hn::ReorderWidenMulAccumulate(di, two, weight, first[k], second[k]);
    }
  } while (++p < w.count16);
  addSums(first, second, 0, w.unit16, onto, u);
}

/// Weights of the four bytes of a quad, and of each two of them with their weights in a sum of sixteen bits: on
/// processors of the x86 kind by one instruction.
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_SSSE3  // or better
using ByteWeights = hn::Vec<Shorts>;
HWY_INLINE ByteWeights byteWeights(const std::array<std::int8_t, 4>& byte) {
  return hn::BitCast(Shorts(), hn::Set(Ints(), std::bit_cast<std::int32_t>(byte)));
}
HWY_INLINE hn::Vec<Shorts> twoSums(hn::Vec<Shorts> four, const ByteWeights& weight) {
#if HWY_TARGET == HWY_AVX2
  return hn::Vec<Shorts>{_mm256_maddubs_epi16(four.raw, weight.raw)};
#elif HWY_TARGET <= HWY_AVX3
  return hn::Vec<Shorts>{_mm512_maddubs_epi16(four.raw, weight.raw)};
#else
  return hn::Vec<Shorts>{_mm_maddubs_epi16(four.raw, weight.raw)};
#endif
}
#else
struct ByteWeights {
  hn::Vec<Shorts> even, odd;
};
HWY_INLINE ByteWeights byteWeights(const std::array<std::int8_t, 4>& byte) {
  return {bothOf({byte[0], byte[2]}), bothOf({byte[1], byte[3]})};
}
HWY_INLINE hn::Vec<Shorts> twoSums(hn::Vec<Shorts> four, const ByteWeights& weight) {
  const hn::RebindToUnsigned<Shorts> du;
  const auto even = hn::And(four, hn::Set(Shorts(), 255));
  const auto odd = hn::BitCast(Shorts(), hn::ShiftRight<8>(hn::BitCast(du, four)));
  return hn::Add(hn::Mul(even, weight.even), hn::Mul(odd, weight.odd));
}
#endif

/// The sum of quads of bytes. @param w  with at least one quad
HWY_INLINE void addQuads(const std::uint8_t* X8, const TileWeights& w, bool onto, float* u) {
  const Ints di;
  hn::Vec<Ints> first[kVectors], second[kVectors];
  for (std::size_t k = 0; k < kVectors; ++k) first[k] = second[k] = hn::Zero(di);
  std::size_t q = 0;
#pragma GCC unroll 4
  do {
    const auto* const quad =
        static_cast<const std::int16_t*>(static_cast<const void*>(X8 + w.quad8[q] * kTile * 4));
    fetchAhead(quad);
    const auto byte = byteWeights(w.weight8[q].byte);
    const auto pair = bothOf(w.weight8[q].pair);
    for (std::size_t k = 0; k < kVectors; ++k) {
      const auto sums = twoSums(hn::LoadU(Shorts(), quad + 2 * k * kLanes), byte);
      first[k] = hn::ReorderWidenMulAccumulate(di, sums, pair, first[k], second[k]);
    }
  } while (++q < w.count8);
  addSums(first, second, w.start8, w.unit8, onto, u);
}

#endif

void SumTiles(const PackedModes& modes, std::size_t pairs, std::size_t quads, const TileWeights& w, bool onto,
              std::span<float> u) {
  const bool any = w.count16 > 0 || w.count8 > 0;
  const std::size_t stored = any ? std::min(u.size(), modes.tiles * kTile) : 0, rest = stored % kTile;
  const auto addTile = [&](std::size_t tile, bool base, float* out) {
    for (std::size_t i = 0; i < kTile; i += kStep) {
      const std::size_t place = tile * kTile;
      const bool both = base || w.count16 > 0;
      if (w.count16 > 0) addPairs(modes.X16.data() + (place * pairs + i) * 2, w, base, out + i);
      if (w.count8 > 0) addQuads(modes.X8.data() + (place * quads + i) * 4, w, both, out + i);
    }
  };
  for (std::size_t tile = 0; tile < stored / kTile; ++tile) addTile(tile, onto, u.data() + tile * kTile);
  if (rest > 0) {
    float last[kTile];
    addTile(stored / kTile, false, last);
    for (std::size_t i = 0; i < rest; ++i) {
      float& number = u[stored - rest + i];
      number = (onto ? number : 0.0F) + last[i];
    }
  }
  if (!onto) std::fill(u.begin() + static_cast<std::ptrdiff_t>(stored), u.end(), 0.0F);
}

}  // namespace HWY_NAMESPACE
}  // namespace palpate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate {

PALPATE_TRUSTED_BEGIN  // as in kernels.cpp

    HWY_EXPORT(SumTiles);

void sumTiles(const PackedModes& modes, std::size_t pairs, std::size_t quads, const TileWeights& weights,
              bool onto, std::span<float> u) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(SumTiles)(modes, pairs, quads, weights, onto, u);
}

PALPATE_TRUSTED_END

}  // namespace palpate
#endif
